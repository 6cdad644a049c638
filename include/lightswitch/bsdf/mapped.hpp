#pragma once

// A surface model under a shading normal that a bump or normal map has turned, and under a coat.

#include <lightswitch/bsdf/coat.hpp>

namespace lightswitch {

/// How a map has turned the shading normal at a point, in the frame of the turned normal.
struct MappedNormal {
    Vec3 before{0, 0, 1};  ///< the normal before, with z > 0
    bool active = false;   ///< false where no map is, and no coat, over which a map may be that turns nothing
    bool flips = false;    ///< where the camera could not see the turned surface, the turn goes the other way
    bool shadows = false;  ///< dims what comes in at grazing angles, see `Mapped`
};

/// The model `B` as the turned surface has it. As in Mitsuba 3.9:
///
/// - black where the turned surface faces away from the camera or the light that the surface before faces, or the other
///   way round: nothing shines through from behind;
/// - where the camera faces the surface but not the turned one, the normal is turned to the other side by as much, so
///   that there are no black flecks (`MappedNormal::flips`);
/// - instead of the hard edge that turned normals give shadows on a curved surface, one as of microfacets of that slope
///   (`MappedNormal::shadows`; Conty Estevez, Lecocq and Stein, "A Microfacet-Based Shadowing Function to Solve the
///   Bump Terminator Problem", Ray Tracing Gems, 2019).
///
/// All that depends on which of the two directions is on the camera's side: `wo` for radiance, `wi` for importance. So
/// methods that trace light see the same surface; they try both normals, by chance.
///
/// With a `coat`, which needs an active map, the model is under that one: it has the turned normal, too.
template <Bsdf B>
struct Mapped : B {
    MappedNormal map;
    const detail::CoatOptics* coat = nullptr;

    BsdfValue evaluate(const Vec3& wo, const Vec3& wi, Transport transport) const {
        if (map.active) [[unlikely]]
            return mapped_value(wo, wi, transport);
        return B::evaluate(wo, wi, transport);
    }
    Maybe<BsdfSample> sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (map.active) [[unlikely]]
            return mapped_sample(wo, u, transport);
        return B::sample(wo, u, transport);
    }
    bool has_dirac_lobe() const { return lightswitch::has_dirac_lobe<B>(*this) || (coat != nullptr && coat->smooth()); }

private:
    [[gnu::noinline]] BsdfValue mapped_value(const Vec3& wo, const Vec3& wi, Transport transport) const {
        const bool from_camera = transport == Transport::radiance;
        const bool flipped = is_flipped(from_camera ? wo : wi);
        if (!keeps(wo, flipped) || !keeps(wi, flipped)) return {};
        const Vec3 seen_wo = seen(wo, flipped), seen_wi = seen(wi, flipped);
        BsdfValue result = coated_value(seen_wo, seen_wi, transport);
        // Methods multiply by the cosine of the light in the frame that is not flipped.
        const Vec3 &light = from_camera ? wi : wo, &seen_light = from_camera ? seen_wi : seen_wo;
        result.value *= light.z != 0 ? std::abs(seen_light.z / light.z) * shadow(light) : 0.0f;
        if (!from_camera && tries_for(wo).both()) result.pdf = result.pdf * 0.5f;
        return result;
    }

    [[gnu::noinline]] Maybe<BsdfSample> mapped_sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        if (transport == Transport::radiance) return sample_from(wo, u, transport, is_flipped(wo));
        const Tries tries = tries_for(wo);
        if (!tries.straight && !tries.flipped) return {};
        if (!tries.both()) return sample_from(wo, u, transport, tries.flipped);
        const bool flipped = u.z >= 0.5f;
        return sample_from(wo, Vec3(Vec2(u), flipped ? 2 * u.z - 1 : 2 * u.z), transport, flipped);
    }

    /// Which of the two normals light from a direction can meet.
    struct Tries {
        bool straight, flipped;
        bool both() const { return straight && flipped; }
    };

    /// The direction in the frame whose normal is turned the other way: half a turn around the normal before.
    Vec3 seen(const Vec3& w, bool flipped) const { return flipped ? 2 * dot(map.before, w) * map.before - w : w; }
    /// Whether the surfaces before and after see the direction from the same side.
    bool keeps(const Vec3& w, bool flipped) const { return seen(w, flipped).z * dot(map.before, w) > 0; }
    bool is_flipped(const Vec3& to_camera) const { return map.flips && !keeps(to_camera, false); }
    Tries tries_for(const Vec3& to_light) const { return {keeps(to_light, false), map.flips && keeps(to_light, true)}; }

    float shadow(const Vec3& to_light) const {
        if (!map.shadows) return 1;
        const auto squared_tangent = [](float cosine) { return 1 / (cosine * cosine) - 1; };
        const float alpha_squared = std::min(0.125f * squared_tangent(map.before.z), 1.0f);
        return 2 / (1 + std::sqrt(1 + alpha_squared * std::max(squared_tangent(dot(map.before, to_light)), 0.0f)));
    }

    Maybe<BsdfSample> sample_from(const Vec3& wo, const Vec3& u, Transport transport, bool flipped) const {
        if (!keeps(wo, flipped)) return {};
        const Vec3 seen_wo = seen(wo, flipped);
        Maybe<BsdfSample> result = coated_sample(seen_wo, u, transport);
        if (!result) return {};
        const Vec3 seen_wi = result->wi, wi = seen(seen_wi, flipped);
        if (!keeps(wi, flipped)) return {};
        const bool from_camera = transport == Transport::radiance;
        const Vec3 &light = from_camera ? wi : wo, &camera = from_camera ? wo : wi;
        const bool chosen = tries_for(light).both();
        if (!from_camera) {
            if (is_flipped(camera) != flipped) return {};  // that camera sees the other normal
            result->weight *= std::abs(seen_wo.z / wo.z * wi.z / seen_wi.z);
            if (chosen) {
                result->weight *= 2;
                result->pdf = result->pdf * 0.5f;
            }
        }
        result->weight *= shadow(light);
        if (chosen) result->reversal *= from_camera ? 0.5f : 2.0f;
        result->wi = wi;
        return result;
    }

    [[gnu::noinline]] BsdfValue coated_value(const Vec3& wo, const Vec3& wi, Transport transport) const {
        detail::CoatEntry from{.inside = wo}, to{.inside = wi};
        if (coat) from = coat->enter(wo), to = coat->enter(wi);
        BsdfValue result;
        if (from.inside.z != 0 && to.inside.z != 0) result = B::evaluate(from.inside, to.inside, transport);
        return coat ? coat->value(wo, wi, from, to, result) : result;
    }

    /// Chooses by `u.z` what the coat reflects, or what is below.
    [[gnu::noinline]] Maybe<BsdfSample> coated_sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        detail::CoatEntry from{.inside = wo};
        Vec3 below = u;
        if (coat) {
            from = coat->enter(wo);
            if (u.z < from.coat_probability)
                return coat->smooth() ? coat->mirrored(wo, from) : facet_sample(wo, u, transport);
            if (!(from.base_probability > 0)) return {};
            below.z = std::min((u.z - from.coat_probability) / from.base_probability, 1 - unit_roundoff);
        }
        Maybe<BsdfSample> result = B::sample(from.inside, below, transport);
        if (coat && result && !coat->leave(wo, from, *result)) return {};
        return result;
    }

    /// From a facet of a rough coat.
    [[gnu::noinline]] Maybe<BsdfSample> facet_sample(const Vec3& wo, const Vec3& u, Transport transport) const {
        const Vec3 wi = coat->reflected(wo, Vec2(u));
        if (wi.z == 0) return {};
        const BsdfValue all = coated_value(wo, wi, transport);
        if (!(all.pdf.value > 0)) return {};
        return BsdfSample{.wi = wi, .weight = all.value * (std::abs(wi.z) / all.pdf.value), .pdf = all.pdf};
    }
};

}  // namespace lightswitch
