// The store thread in virtual time: the product's StoreWork, each of whose operations takes as long as the disk does,
// and may be cut off in its middle.
#pragma once

#include "context.hpp"
#include "ram_disk.hpp"
#include "random.hpp"
#include "store/store_work.hpp"

#include <cstdint>
#include <deque>
#include <vector>

namespace linefeed::simulation {

/// Flow: push() requests; done() and wake() for its events; take_replies() after each. As store::StoreThread::run().
class VirtualStore {
public:
    VirtualStore(Context& context, Random random, store::StoreWork work, std::uint64_t generation);

    void push(store::StoreRequest request);
    [[nodiscard]] std::size_t waiting() const { return requests_.size(); }
    void done();
    void wake();
    [[nodiscard]] std::vector<store::StoreReply> take_replies() { return work_.take_replies(); }
    /// The End request is carried out.
    [[nodiscard]] bool ended() const { return work_.ended() && !busy_; }
    /// What went wrong with the storage; empty = nothing.
    [[nodiscard]] const std::string& failure() const { return work_.failure(); }
    /// The disk is slow until then.
    void slow_until(Instant until) { slow_until_ = until; }
    /// The process dies: the operation under way is cut off somewhere.
    void die();

private:
    enum class Operation { take, commit, read, checkpoint };
    void go_on();
    [[nodiscard]] bool choose(Operation& operation);
    void begin(Operation operation);
    void execute();

    Context& context_;
    Random random_;
    store::StoreWork work_;
    std::uint64_t generation_;
    std::deque<store::StoreRequest> requests_;
    Operation operation_ = Operation::commit;
    bool busy_ = false;
    bool executed_ = false; ///< the operation has reached the disk at its beginning, not at its end
    Instant last_commit_;
    Instant last_checkpoint_;
    Instant wake_at_{};
    Instant slow_until_{};
};

} // namespace linefeed::simulation
