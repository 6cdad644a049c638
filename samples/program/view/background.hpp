#pragma once

// One piece of work at a time on a thread of its own.

#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

namespace lightswitch::program {

/// Work whose newest result can be fetched at any time. To be used from one thread.
template <class Result>
class Background {
public:
    /// Gives a new result; may be called several times, on the working thread.
    using Publish = std::function<void(Result)>;

    /// Ends what is under way, forgets its results, and begins anew. What `work` throws must not leave it.
    void start(std::function<void(const std::stop_token&, const Publish&)> work) {
        stop();
        const auto shared = shared_ = std::make_shared<Shared>();
        thread_ = std::jthread([shared, work = std::move(work)](const std::stop_token& stop) {
            work(stop, [&](Result result) {
                auto made = std::make_shared<const Result>(std::move(result));
                const std::lock_guard lock(shared->mutex);
                shared->result = std::move(made);
            });
        });
    }
    void stop() {
        thread_ = {};
        shared_.reset();
    }
    /// The newest result; empty when there is none.
    std::shared_ptr<const Result> result() const {
        if (!shared_) return {};
        const std::lock_guard lock(shared_->mutex);
        return shared_->result;
    }

private:
    struct Shared {
        std::mutex mutex;
        std::shared_ptr<const Result> result;
    };
    std::shared_ptr<Shared> shared_;
    std::jthread thread_;
};

}  // namespace lightswitch::program
