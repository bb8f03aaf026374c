// The network between host and printer: latency, jitter, split and merged pieces, stalls, cuts announced and silent.
// Bytes of one direction of one connection never overtake each other; what a dead process left in its socket still
// arrives.
#pragma once

#include "context.hpp"
#include "random.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::simulation {

/// Who gets the bytes.
class WireEnds {
public:
    virtual ~WireEnds() = default;
    virtual void printer_receives(std::uint64_t connection, std::string_view bytes) = 0;
    virtual void host_receives(std::uint64_t connection, std::string_view bytes) = 0;
};

class Wire {
public:
    Wire(Context& context, Random random);

    /// A new connection; its id.
    [[nodiscard]] std::uint64_t open();
    void to_printer(std::uint64_t connection, std::string_view bytes) { send(connection, true, bytes); }
    void to_host(std::uint64_t connection, std::string_view bytes) { send(connection, false, bytes); }
    /// An event of kind chunk.
    void deliver(std::uint64_t chunk, WireEnds& ends);

    /// The host's end is closed in good order; what was sent still arrives.
    void host_closes(std::uint64_t connection);
    /// The printer's end is gone. `announced`: the host is told.
    void printer_closes(bool announced);
    /// Both ends are cut off. `announced`: both are told; otherwise neither.
    void cut(bool announced);
    /// Nothing arrives before `until`.
    void stall(Instant until);
    void set_down(bool down) { down_ = down; }
    [[nodiscard]] bool down() const { return down_; }
    [[nodiscard]] Duration latency() {
        return random_.between(context_.scenario.latency.low, context_.scenario.latency.high);
    }

private:
    struct Connection {
        std::uint64_t id = 0;
        bool host_open = true;
        bool printer_open = true;
        Instant last_to_printer{};
        Instant last_to_host{};
    };
    struct Chunk {
        std::uint64_t connection = 0;
        bool to_printer = false;
        std::string bytes;
    };
    [[nodiscard]] Connection* find(std::uint64_t id);
    void send(std::uint64_t connection, bool to_printer, std::string_view bytes);
    void put(Connection& connection, bool to_printer, std::string_view bytes);
    void damage(std::string& bytes, bool to_printer);
    void damage_anything(std::string& bytes, bool to_printer);

    Context& context_;
    Random random_;
    std::vector<Connection> connections_; ///< the newest last
    std::vector<Chunk> chunks_;
    std::vector<std::uint64_t> free_chunks_;
    Instant stalled_until_{};
    std::uint64_t last_id_ = 0;
    bool down_ = false;
    bool noise_to_printer_ = false; ///< on the last chunk
    std::uint32_t record_ = 0;      ///< the first in what is being sent; 0 = none
};

} // namespace linefeed::simulation
