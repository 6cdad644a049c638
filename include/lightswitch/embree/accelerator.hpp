#pragma once

// RAII over Embree: one committed scene of triangles, spheres and other scenes that rays can be traced through.

#include <lightswitch/core/ray_count.hpp>
#include <lightswitch/embree/device.hpp>
#include <lightswitch/geometry/ray.hpp>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <array>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace lightswitch::embree {

/// What a ray hit, as Embree says it.
struct Hit {
    std::uint32_t geometry;   ///< what `Accelerator::add` returned
    std::uint32_t primitive;  ///< index among the triangles or spheres of that geometry
    float u, v;               ///< barycentric weights of a triangle's second and third corner
    float distance;           ///< in multiples of the ray's direction
    Vec3 normal;              ///< of a triangle, on the side from which its corners run counter-clockwise; any length
    std::uint32_t instance;   ///< what `Accelerator::add_instance` returned, or `no_instance`

    static constexpr std::uint32_t no_instance = RTC_INVALID_GEOMETRY_ID;
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
    explicit Accelerator(const std::string& config = "") : Accelerator(std::make_shared<const Device>(config)) {}
    /// On the device of others, which it may contain.
    explicit Accelerator(std::shared_ptr<const Device> device) : device_(std::move(device)) {
        scene_.reset(rtcNewScene(device_->get()));
        device_->check("making a scene");
    }

    /// Copies a triangle mesh into Embree's own (padded) buffers; returns its number, counted from 0.
    std::uint32_t add(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles) {
        const Geometry geometry(rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, positions);
        fill(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, triangles);
        return attach(geometry);
    }

    /// The same for spheres.
    std::uint32_t add(std::span<const SphereData> spheres) {
        const Geometry geometry(rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_SPHERE_POINT));
        fill(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, spheres);
        return attach(geometry);
    }

    /// Another accelerator of the same device, already committed, seen under an affine `to_world` (columns; with an
    /// inverse); returns its number, counted like those of the other geometries. Positions, distances and `Hit::normal`
    /// of what it holds stay in its own coordinates.
    std::uint32_t add_instance(const Accelerator& inner, const std::array<Vec3, 4>& to_world) {
        const Geometry geometry(rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_INSTANCE));
        rtcSetGeometryInstancedScene(geometry.get(), inner.handle());
        static_assert(sizeof to_world == 12 * sizeof(float));
        rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, to_world.data());
        return attach(geometry);
    }

    /// The corners of the triangle `primitive` of a committed triangle mesh.
    std::array<Vec3, 3> corners(std::uint32_t geometry, std::uint32_t primitive) const {
        const RTCGeometry mesh = rtcGetGeometry(scene_.get(), geometry);
        const auto* positions = static_cast<const Vec3*>(rtcGetGeometryBufferData(mesh, RTC_BUFFER_TYPE_VERTEX, 0));
        const auto* triangles =
            static_cast<const std::array<std::uint32_t, 3>*>(rtcGetGeometryBufferData(mesh, RTC_BUFFER_TYPE_INDEX, 0));
        const auto& [a, b, c] = triangles[primitive];
        return {positions[a], positions[b], positions[c]};
    }

    /// Builds the acceleration structure, also anew. `robust` asks Embree for its watertight intersection test.
    void commit(bool robust = false) {
        const auto start = std::chrono::steady_clock::now();
        if (robust) {
            rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
            // Where it is built already, other flags alone are no reason for Embree to build it anew.
            for (std::uint32_t i = 0; build_seconds_ > 0 && i < geometries_; ++i)
                rtcCommitGeometry(rtcGetGeometry(scene_.get(), i));
        }
        rtcCommitScene(scene_.get());
        device_->check("building the acceleration structure of " + std::to_string(geometries_) + " shapes");
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
        hit = {query.hit.geomID,   query.hit.primID, query.hit.u,
               query.hit.v,        query.ray.tfar,   Vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z),
               query.hit.instID[0]};
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
    const std::shared_ptr<const Device>& device() const { return device_; }
    /// Bytes that Embree holds for this accelerator and the others of its device.
    std::int64_t memory() const { return device_->memory(); }

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
        device_->check("allocating a buffer of " + std::to_string(data.size()) + " elements");
        if (!buffer) throw Error("Embree gave no memory for a buffer of " + std::to_string(data.size()) + " elements");
        std::copy(data.begin(), data.end(), static_cast<T*>(buffer));
    }

    std::uint32_t attach(const Geometry& geometry) {
        // Embree 4 gives geometries mask 1 and tests masks when built so; all ones is right for every version.
        rtcSetGeometryMask(geometry.get(), 0xffffffffu);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometryByID(scene_.get(), geometry.get(), geometries_);
        device_->check("adding a geometry");
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

    std::shared_ptr<const Device> device_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
    std::uint32_t geometries_ = 0;
    double build_seconds_ = 0;
};

}  // namespace lightswitch::embree
