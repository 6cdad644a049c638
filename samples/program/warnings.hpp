#pragma once

// What the program warns of before and after a render.

#include "load.hpp"

#include <lightswitch/method/any_method.hpp>

#include <optional>
#include <string_view>

namespace lightswitch::program {

/// What the method will not see of the scene, and what nobody will.
void warn_about_scene(const LoadedScene& loaded, std::string_view method);

/// Lamps that lie in other surfaces.
void warn_about_coincident_lights(const AnyScene& scene, const LibraryDescription& description);

/// Path lengths that are asked for and of no use to the method.
void warn_about_depths(const AnyMethod& method, const std::optional<int>& max_depth,
                       const std::optional<int>& rr_depth);

/// Values that were not finite, and how to meet the first of them again.
void warn_about_values(const RenderCounts& counts, const Image& image);

/// Light that rests on few rare paths, so that the image and its estimated error may be off there.
void warn_about_coverage(const RenderStatistics& statistics);

/// Samples after which an image that is still black ends a render which nothing but --error would end.
inline constexpr std::uint64_t most_black_samples = 256;
void warn_about_black(std::uint64_t samples);

}  // namespace lightswitch::program
