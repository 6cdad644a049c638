#pragma once

// Renders that are denoised (`render --denoise`).

#include "run.hpp"

#include <lightswitch/reconstruct/mix.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace lightswitch::program {

inline constexpr std::array<std::string_view, 3> denoiser_names{"auto", "oidn", "own"};

/// The name of the denoiser that is used, where that is asked for: `auto` is oidn where it is there. Throws `Error`
/// where oidn is asked for and is not.
std::string choose_denoiser(std::string_view wanted);

/// What denoising came to.
struct Denoising {
    std::string denoiser;  ///< empty: there was none
    Mixed mixed;           ///< but its image, which is in `Rendered`
    Image samples;         ///< as they were
    double seconds = 0;    ///< of denoising at the end
};

/// As `run`, with half of the samples by another seed, and the result denoised. The budget's error is that of the
/// result. `guides` are the layers albedo and normal.
Rendered run_denoised(const AnyScene& scene, const AnyMethod& method, const Job& job, const std::vector<Layer>& guides,
                      Denoising& denoising);

/// Warns where denoiser and samples contradict each other, and where nothing could be told.
void warn_about_denoising(const Denoising& denoising, std::uint64_t samples);

/// The layers error, from_samples and samples.
void add_denoising_layers(std::vector<Layer>& layers, const Denoising& denoising);

}  // namespace lightswitch::program
