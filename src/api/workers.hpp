// The threads that call daemon::Operations, which may wait for the store or a printer: a few for each lane, and a bound
// to what waits for them, so that a slow disk shows as "busy" and not as memory.
#pragma once

#include "api/route.hpp"

#include <array>
#include <atomic>
#include <functional>
#include <memory>

namespace linefeed::api {

/// Any thread.
class Workers {
public:
    /// So many may wait or be carried out in a lane.
    static constexpr std::size_t max_tasks = 256;

    Workers();
    /// Waits for what was begun and what waits.
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// False = the lane is full. `task` throws nothing. Precondition: not Lane::at_once.
    [[nodiscard]] bool post(Lane lane, std::function<void()> task);
    /// As the destructor; what is posted afterwards is refused.
    void finish();

private:
    struct Pool;
    std::array<std::unique_ptr<Pool>, lanes> pools_;
    std::atomic<bool> finished_ = false;
};

} // namespace linefeed::api
