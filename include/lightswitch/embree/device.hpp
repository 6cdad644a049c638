#pragma once

// RAII over Embree's device: where its memory and its errors are kept.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/parallel.hpp>
#include <lightswitch/embree/api.hpp>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace lightswitch::embree {

/// An Embree device. Errors that Embree reports are kept and thrown as `Error` by `check`, never out of Embree's
/// callback. Safe to share between threads.
class Device {
public:
    /// `config` is Embree's own string, for example "threads=2,verbose=1,isa=avx2"; empty for the defaults. Throws
    /// `Error` when Embree cannot read it; keys that Embree does not know it ignores.
    explicit Device(const std::string& config = "") : state_(std::make_unique<State>()) {
        lightswitch::detail::allow_threads(tbb::info::default_concurrency());  // Embree builds by oneTBB
        device_.reset(rtcNewDevice(config.empty() ? nullptr : config.c_str()));
        if (!device_)
            throw Error("Embree could not make a device from the configuration \"" + config + "\" (error " +
                        std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))) + ")");
        rtcSetDeviceErrorFunction(device_.get(), &State::on_error, state_.get());
        rtcSetDeviceMemoryMonitorFunction(device_.get(), &State::on_memory, state_.get());
    }

    RTCDevice get() const { return device_.get(); }

    /// Throws the first error recorded since the last call, saying what was being done.
    void check(const std::string& doing) const {
        const std::lock_guard lock(state_->mutex);
        if (state_->message.empty()) return;
        const std::string message = std::exchange(state_->message, {});
        throw Error("Embree, while " + doing + ": " + message);
    }

    /// Bytes that Embree holds on this device.
    std::int64_t memory() const { return state_->memory.load(); }

private:
    struct State {
        std::mutex mutex;
        std::string message;
        std::atomic<std::int64_t> memory{0};

        static void on_error(void* self, RTCError code, const char* text) {
            auto& state = *static_cast<State*>(self);
            const std::lock_guard lock(state.mutex);
            if (state.message.empty())
                state.message =
                    (text ? text : "no text") + std::string(" (error ") + std::to_string(static_cast<int>(code)) + ")";
        }
        static bool on_memory(void* self, ssize_t bytes, bool) {
            static_cast<State*>(self)->memory += bytes;
            return true;
        }
    };
    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    };
    std::unique_ptr<State> state_;
    std::unique_ptr<RTCDeviceTy, Release> device_;
};

}  // namespace lightswitch::embree
