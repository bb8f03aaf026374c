// How many connections there may be, in all and from one address, so that no client takes them all.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace linefeed::api {

/// Lives on one thread.
class ConnectionLimits {
public:
    enum class Verdict {
        admitted,
        too_many,              ///< in all
        too_many_from_address, ///< of this client
    };

    explicit ConnectionLimits(std::size_t most)
        : most_(most) {}

    void set_most(std::size_t most) { most_ = most; }
    [[nodiscard]] std::size_t open() const { return open_; }
    /// From one address: a quarter of all, at least 4. The loopback is not one client: there, and behind a proxy on
    /// this machine, any number of them have the same address.
    [[nodiscard]] std::size_t most_from_address() const;

    [[nodiscard]] Verdict verdict(const std::string& address) const;
    /// Precondition of leave(): enter() with the same address.
    void enter(const std::string& address);
    void leave(const std::string& address);

private:
    std::size_t most_;
    std::size_t open_ = 0;
    std::map<std::string, std::size_t> by_address_;
};

/// One connection that counts, for as long as it lives.
class ConnectionSlot {
public:
    ConnectionSlot(ConnectionLimits& limits, std::string address)
        : limits_(limits)
        , address_(std::move(address)) {
        limits_.enter(address_);
    }
    ConnectionSlot(const ConnectionSlot&) = delete;
    ConnectionSlot& operator=(const ConnectionSlot&) = delete;
    ~ConnectionSlot() { limits_.leave(address_); }

private:
    ConnectionLimits& limits_;
    std::string address_;
};

} // namespace linefeed::api
