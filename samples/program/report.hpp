#pragma once

// From verdicts and images to the report page.

#include <lightswitch/compare/report.hpp>
#include <lightswitch/compare/verdict.hpp>

#include <string>
#include <vector>

namespace lightswitch::program {

/// An image with what it is called.
struct NamedImage {
    std::string name;
    Image image;
};

/// How many samples per pixel the image's file says that it holds; 0 when it does not say.
double samples_of(const Image& image);

/// Images against one of them: metrics, maps, and error over samples where the files say how many they hold.
Report comparison_report(const std::vector<NamedImage>& images, std::size_t reference);

/// The verdicts of one run, which share their reference.
Report verdict_report(const std::string& scene, const std::vector<Verdict>& verdicts);

}  // namespace lightswitch::program
