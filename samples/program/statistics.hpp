#pragma once

// What --stats writes.

#include "denoising.hpp"
#include "load.hpp"
#include "program.hpp"
#include "run.hpp"

#include <string>

namespace lightswitch::program {

/// The numbers of a render as JSON text. Programs read it: keys are added, never renamed.
std::string statistics_json(const LoadedScene& loaded, const AnyMethod& method, const RenderOptions& options,
                            const Rendered& rendered, const Denoising& denoising);

}  // namespace lightswitch::program
