#pragma once

#include <lightswitch/film/image.hpp>

#include <string>

namespace lightswitch {

/// An image beside the main one in a file (`save_layers`), such as a guide for a denoiser.
struct Layer {
    std::string name;
    std::string channels;  ///< a letter for each component of the pixels that is kept: "RGB", "XYZ" or a single one
    Image image;
};

}  // namespace lightswitch
