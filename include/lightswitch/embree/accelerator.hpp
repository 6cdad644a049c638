#pragma once

// RAII over Embree: a device, and one committed scene of triangles and spheres that rays can be traced through.

#include <lightswitch/core/error.hpp>
#include <lightswitch/core/parallel.hpp>
#include <lightswitch/core/ray_count.hpp>
#include <lightswitch/embree/api.hpp>
#include <lightswitch/geometry/ray.hpp>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <span>
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

/// What a ray hit, as Embree says it.
struct Hit {
    std::uint32_t geometry;   ///< what `Accelerator::add` returned
    std::uint32_t primitive;  ///< index among the triangles or spheres of that geometry
    float u, v;               ///< barycentric weights of a triangle's second and third corner
    float distance;           ///< in multiples of the ray's direction
    Vec3 normal;              ///< of a triangle, on the side from which its corners run counter-clockwise; any length
};

/// An Embree scene: geometries are added, then it is committed, and then it is immutable and rays may be traced from
/// any number of threads.
///
/// Embree answers a ray that is not finite with anything from a wrong hit to the end of the process, so it is not
/// asked: such a ray meets nothing, and is counted. So is one with coordinates beyond `largest_coordinate`, and one
/// whose direction is 0. A `near` below 0 counts as 0.
class Accelerator {
public:
    struct SphereData {
        Vec3 center;
        float radius;
    };

    /// The sum of the sizes of a ray's origin and direction, in each axis, up to which Embree takes it.
    static constexpr float largest_coordinate = 1.844e18f;

    /// `config` as for `Device`.
    explicit Accelerator(const std::string& config = "") : device_(config) {
        scene_.reset(rtcNewScene(device_.get()));
        device_.check("making a scene");
    }

    /// Copies a triangle mesh into Embree's own (padded) buffers; returns its number, counted from 0.
    std::uint32_t add(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles) {
        const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, positions);
        fill(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles);
        return attach(geometry);
    }

    /// The same for spheres.
    std::uint32_t add(std::span<const SphereData> spheres) {
        const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT));
        fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, spheres);
        return attach(geometry);
    }

    /// Builds the acceleration structure. `robust` asks Embree for its watertight intersection test.
    void commit(bool robust = false) {
        const auto start = std::chrono::steady_clock::now();
        if (robust) rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_.get());
        device_.check("building the acceleration structure of " + std::to_string(geometries_) + " shapes");
        build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    /// Closest hit between `ray.near` and `ray.far`; false when there is none.
    [[gnu::always_inline]] bool intersect(const Ray& ray, Hit& hit) const {
        RTCRayHit query;
        set(query.ray, ray);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        ++ray_count.intersect;
        embree::intersect(scene_.get(), query);
        hit = {query.hit.geomID, query.hit.primID, query.hit.u,
               query.hit.v,      query.ray.tfar,   Vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z)};
        return hit.geometry != RTC_INVALID_GEOMETRY_ID || missed(query.ray);
    }

    /// Whether anything lies between `ray.near` and `ray.far`.
    [[gnu::always_inline]] bool occluded(const Ray& ray) const {
        RTCRay query;
        set(query, ray);
        ++ray_count.occluded;
        embree::occluded(scene_.get(), query);
        return query.tfar < 0 || missed(query);
    }

    RTCScene handle() const { return scene_.get(); }
    double build_seconds() const { return build_seconds_; }
    std::int64_t memory() const { return device_.memory(); }

private:
    struct ReleaseScene {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    struct ReleaseGeometry {
        void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
    };
    using Geometry = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

    template <class T>
    void fill(const Geometry& geometry, RTCBufferType type, RTCFormat format, std::span<const T> data) {
        void* const buffer = rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, sizeof(T), data.size());
        device_.check("allocating a buffer of " + std::to_string(data.size()) + " elements");
        if (!buffer) throw Error("Embree gave no memory for a buffer of " + std::to_string(data.size()) + " elements");
        std::copy(data.begin(), data.end(), static_cast<T*>(buffer));
    }

    std::uint32_t attach(const Geometry& geometry) {
        // Embree 4 gives geometries mask 1 and tests masks when built so; all ones is right for every version.
        rtcSetGeometryMask(geometry.get(), 0xffffffffu);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(scene_.get(), geometry.get(), geometries_);
        device_.check("adding a geometry");
        return geometries_++;
    }

    using Four [[gnu::vector_size(16)]] = float;
    using FourBits [[gnu::vector_size(16)]] = std::int32_t;

    /// Writes origin and direction as whole vectors: Embree reads them so, and a read of four separate writes would
    /// stall.
    [[gnu::always_inline]] static void set(RTCRay& query, const Ray& ray) {
        const float near = std::max(ray.near, 0.0f);
        const Four origin{ray.origin.x, ray.origin.y, ray.origin.z, near};
        const Four direction{ray.direction.x, ray.direction.y, ray.direction.z, 0};
        static_assert(offsetof(RTCRay, tnear) == 12 && offsetof(RTCRay, dir_x) == 16 && offsetof(RTCRay, time) == 28);
        std::memcpy(&query, &origin, sizeof origin);
        std::memcpy(&query.dir_x, &direction, sizeof direction);
        query.tfar = ray.far;
        query.mask = 0xffffffffu;
        query.id = 0;
        query.flags = 0;
        if (!(is_within_limits(origin, direction) && ray.far >= near)) [[unlikely]]
            disarm(query);
    }

    /// Puts a ray that meets nothing in the place of one that Embree must not see, or that ends before it begins; only
    /// the former is counted. A ray instead of an early return: a second way out would cost the inner loops more than
    /// the check.
    [[gnu::noinline, gnu::cold]] static void disarm(RTCRay& query) {
        const Four origin{query.org_x, query.org_y, query.org_z, 0},
            direction{query.dir_x, query.dir_y, query.dir_z, 0};
        ray_count.refused += !(is_within_limits(origin, direction) && query.tfar < query.tnear);
        query.org_x = query.org_y = query.org_z = query.dir_x = query.dir_y = query.tfar = 0;
        query.dir_z = query.tnear = 1;
    }

    /// False. Whether a ray has a direction at all is asked here, after Embree, where it costs those that hit something
    /// nothing.
    [[gnu::always_inline]] static bool missed(const RTCRay& query) {
        if (query.dir_x == 0) [[unlikely]]
            ray_count.refused += query.dir_y == 0 && query.dir_z == 0;
        return false;
    }

    /// Whether |a| + |b| is at most `largest_coordinate`, and a number, in the first three lanes.
    [[gnu::always_inline]] static bool is_within_limits(const Four& a, const Four& b) {
        constexpr FourBits no_sign{0x7fffffff, 0x7fffffff, 0x7fffffff, 0};
        constexpr Four limit{largest_coordinate, largest_coordinate, largest_coordinate, largest_coordinate};
        const Four sum = std::bit_cast<Four>(std::bit_cast<FourBits>(a) & no_sign) +
                         std::bit_cast<Four>(std::bit_cast<FourBits>(b) & no_sign);
        return lanes_set(sum <= limit) == 0xf;
    }

    /// One bit for every lane of a comparison.
    [[gnu::always_inline]] static int lanes_set(const FourBits& comparison) {
#if defined(__SSE2__)
        return _mm_movemask_ps(std::bit_cast<__m128>(comparison));
#else
        int bits = 0;
        for (int i = 0; i < 4; ++i) bits |= (comparison[i] & 1) << i;
        return bits;
#endif
    }

    Device device_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
    std::uint32_t geometries_ = 0;
    double build_seconds_ = 0;
};

}  // namespace lightswitch::embree
