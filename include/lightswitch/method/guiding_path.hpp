#pragma once

// What a path tells of the light at its vertices, once it has ended.

#include <lightswitch/bsdf/bsdf.hpp>
#include <lightswitch/method/guiding_field.hpp>

#include <array>

namespace lightswitch {

/// Gathers a path from the camera, of whose first 32 vertices it tells (`GuidingRecord`). To be told, for every vertex:
/// `arrive` (of the light that the ray to it has met), `visit`, `direct`, `leave`, `survive`.
class GuidingPath {
public:
    /// The path has met light, or escaped to it: without its throughput, with its weight.
    void arrive(const Rgb& radiance) {
        if (open_ && size_ > 0) vertices_[size_ - 1].met += radiance;
    }
    /// It goes on at a vertex in that region, with that throughput.
    void visit(std::uint32_t region, const Rgb& throughput) {
        open_ = size_ < vertices_.size();
        if (open_) {
            vertices_[size_] = {};
            vertices_[size_].region = region;
            vertices_[size_++].throughput = luminance(throughput);
        }
    }
    /// Light that was sampled there, as the vertex scatters it.
    void direct(const Rgb& radiance) {
        if (open_) vertices_[size_ - 1].direct += radiance;
    }
    /// It leaves the vertex along `wi`, with that cosine, chosen with the density in `sample`.
    void leave(const Vec3& wi, const BsdfSample& sample, SolidAnglePdf bsdf, SolidAnglePdf guide) {
        if (!open_) return;
        Vertex& v = vertices_[size_ - 1];
        v.left = true;
        v.smooth = !sample.specular;
        v.direction = wi;
        v.cosine = std::abs(sample.wi.z);
        v.weight = sample.weight;
        v.pdf = sample.pdf;
        v.bsdf = bsdf;
        v.guide = guide;
    }
    /// Roulette lets it go on with that probability.
    void survive(float probability) {
        if (open_) vertices_[size_ - 1].survival = probability;
    }

    /// Calls `push(record)` for every vertex, the last one first.
    void finish(const auto& push) const {
        Rgb outgoing(0);  // from the vertex after the one at hand
        for (std::size_t i = size_; i-- > 0;) {
            const Vertex& v = vertices_[i];
            const Rgb incident = (v.met + outgoing) * (1 / v.survival);
            const Rgb scattered = v.left ? incident * v.weight : Rgb(0);
            outgoing = scattered + v.direct;
            GuidingRecord record;
            record.region = v.region;
            record.smooth = v.left && v.smooth;
            if (record.smooth) {
                record.place = octahedron::to_square(v.direction);
                record.incident = luminance(incident) * v.cosine;
                record.scattered = luminance(scattered) * v.throughput;
                record.pdf = v.pdf;
                record.bsdf = v.bsdf;
                record.guide = v.guide;
                record.smooth =
                    is_finite(record.incident) && is_finite(record.scattered) && v.pdf < SolidAnglePdf{infinity};
            }
            push(record);
        }
    }

private:
    struct Vertex {
        std::uint32_t region = 0;
        float throughput = 1, cosine = 0, survival = 1;
        bool left = false, smooth = false;
        Vec3 direction{0};
        Rgb weight{0}, direct{0}, met{0};
        SolidAnglePdf pdf, bsdf, guide;
    };

    std::array<Vertex, 32> vertices_;
    std::size_t size_ = 0;
    bool open_ = false;  // whether the last vertex is the one at hand
};

}  // namespace lightswitch
