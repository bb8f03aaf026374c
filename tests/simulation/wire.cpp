#include "wire.hpp"

#include "base/assert.hpp"

#include <algorithm>
#include <charconv>

namespace linefeed::simulation {

namespace {
constexpr std::size_t connections_kept = 16; ///< older ones have nothing in flight any more

std::uint32_t first_record(std::string_view bytes) {
    constexpr std::string_view mail = "^0=MR";
    std::uint32_t number = 0;
    if (const auto at = bytes.find(mail); at != std::string_view::npos) {
        std::from_chars(bytes.data() + at + mail.size(), bytes.data() + bytes.size(), number);
    }
    return number;
}

} // namespace

Wire::Wire(Context& context, Random random)
    : context_(context)
    , random_(random) {}

std::uint64_t Wire::open() {
    if (connections_.size() == connections_kept) {
        connections_.erase(connections_.begin());
    }
    connections_.push_back({++last_id_, true, true, context_.now, context_.now});
    return last_id_;
}

Wire::Connection* Wire::find(std::uint64_t id) {
    const auto found = std::find_if(connections_.rbegin(), connections_.rend(),
                                    [id](const Connection& connection) { return connection.id == id; });
    return found == connections_.rend() ? nullptr : &*found;
}

void Wire::send(std::uint64_t connection, bool to_printer, std::string_view bytes) {
    Connection* it = find(connection);
    if (it == nullptr) {
        return;
    }
    record_ = to_printer ? first_record(bytes) : 0;
    while (!bytes.empty()) {
        const bool splits = context_.scenario.split > 0 && bytes.size() > 1 && random_.chance(context_.scenario.split);
        const std::size_t size = splits ? random_.between(1, bytes.size() - 1) : bytes.size();
        put(*it, to_printer, bytes.substr(0, size));
        bytes.remove_prefix(size);
    }
}

void Wire::put(Connection& connection, bool to_printer, std::string_view bytes) {
    Instant& last = to_printer ? connection.last_to_printer : connection.last_to_host;
    last = std::max({last, context_.now + latency(), stalled_until_});
    std::uint64_t index = chunks_.size();
    if (free_chunks_.empty()) {
        chunks_.emplace_back();
    } else {
        index = free_chunks_.back();
        free_chunks_.pop_back();
    }
    Chunk& chunk = chunks_[index];
    chunk.connection = connection.id;
    chunk.to_printer = to_printer;
    chunk.bytes.assign(bytes);
    const bool noise = context_.scenario.damage > 0 && random_.chance(context_.scenario.damage);
    if (noise && context_.scenario.crc) {
        if (to_printer) {
            context_.noise.at_printer = last;
        }
        if (record_ != 0) {
            context_.noise.record = record_;
            context_.noise.record_left_at = context_.now;
        }
        damage_anything(chunk.bytes, to_printer);
    } else if (noise && !(to_printer && noise_to_printer_)) {
        damage(chunk.bytes, to_printer);
    }
    if (to_printer) {
        noise_to_printer_ = noise;
    }
    context_.queue.put(last, EventKind::chunk, index);
}

/// A serial line loses a byte, or makes one of another. Without CRC32 nobody can tell a digit from another, or a letter
/// on a product: so a digit of an answer becomes no other digit, and of what goes to the printer only the ends of
/// frames are hit, and no two in a row, which would make one frame of two.
void Wire::damage(std::string& bytes, bool to_printer) {
    std::size_t at = random_.below(bytes.size());
    if (to_printer) {
        at = bytes.find_first_of("^\r", at);
        if (at == std::string::npos || (at > 0 && bytes[at - 1] == '\\')) {
            return;
        }
    }
    if (random_.chance(0.5)) {
        bytes[at] = static_cast<char>(0x80U | random_.below(0x80));
    } else {
        bytes.erase(at, 1);
    }
    context_.trace.say(context_.now, to_printer ? "damaged to printer" : "damaged to host", bytes);
    ++context_.counts.bytes_damaged;
}

/// With CRC32 nothing is spared: up to three bytes anywhere are changed into any other, or lost.
void Wire::damage_anything(std::string& bytes, bool to_printer) {
    for (std::uint64_t hits = 1 + random_.below(3); hits > 0 && !bytes.empty(); --hits) {
        const std::size_t at = random_.below(bytes.size());
        if (random_.chance(0.7)) {
            bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1 + random_.below(0xFF)));
        } else {
            bytes.erase(at, 1);
        }
    }
    context_.trace.say(context_.now, to_printer ? "damaged to printer" : "damaged to host", bytes);
    ++context_.counts.bytes_damaged;
}

void Wire::deliver(std::uint64_t index, WireEnds& ends) {
    std::string bytes;
    bytes.swap(chunks_[index].bytes);
    const Connection* connection = find(chunks_[index].connection);
    const bool to_printer = chunks_[index].to_printer;
    if (connection != nullptr && !bytes.empty() && (to_printer ? connection->printer_open : connection->host_open)) {
        if (to_printer) {
            ends.printer_receives(connection->id, bytes);
        } else {
            ends.host_receives(connection->id, bytes);
        }
    }
    chunks_[index].bytes.swap(bytes); // keeps its memory
    free_chunks_.push_back(index);
}

void Wire::host_closes(std::uint64_t connection) {
    if (Connection* it = find(connection); it != nullptr && it->host_open) {
        it->host_open = false;
        context_.queue.put(std::max(it->last_to_printer, context_.now + latency()), EventKind::peer_closed, connection);
    }
}

void Wire::printer_closes(bool announced) {
    for (Connection& connection : connections_) {
        if (connection.printer_open) {
            connection.printer_open = false;
            if (announced && connection.host_open) {
                context_.queue.put(std::max(connection.last_to_host, context_.now + latency()), EventKind::link_closed,
                                   connection.id);
            }
        }
    }
}

void Wire::cut(bool announced) {
    for (Connection& connection : connections_) {
        if (announced && connection.host_open) {
            context_.after(latency(), EventKind::link_closed, connection.id);
        }
        if (announced && connection.printer_open) {
            context_.after(latency(), EventKind::peer_closed, connection.id);
        }
        connection.printer_open = false;
        connection.host_open = false;
    }
}

void Wire::stall(Instant until) {
    stalled_until_ = std::max(stalled_until_, until);
}

} // namespace linefeed::simulation
