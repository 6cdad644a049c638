#pragma once

// Classic mistakes of renderers, planted one by one in copies of the library's methods, surface models and lights, each
// with a small scene that shows it: what a statistical test of renderers has to find. And pairs that are right, for
// counting false alarms.

#include <lightswitch/verify/estimator.hpp>

#include <functional>
#include <string_view>
#include <utility>
#include <vector>

namespace lightswitch::test {

/// One mistake. Expected values of the two images differ only by it.
struct PlantedBug {
    std::string_view name;
    std::string_view scene;
    /// The limit of the path length (1 is emission seen directly, 2 adds direct light, ...) from which on the images
    /// differ; 0 when they do not.
    int first_length = 0;
    /// Builds the scenes: the estimator that is wrong, and one that is right. They own what they refer to.
    std::function<std::pair<Estimator, Estimator>()> make;
    /// The expected value is right, but neighbouring pixels share random numbers although the estimator says that they
    /// do not.
    bool correlated = false;
};

/// Two estimators of one image, made independently of each other. Both are right.
struct CorrectPair {
    std::string_view name;
    std::string_view scene;
    std::function<std::pair<Estimator, Estimator>()> make;
};

/// Mistakes in methods, surface models, lights and random numbers.
std::vector<PlantedBug> planted_bugs();
/// Mistakes about all surface models, layers, textures, instances and lights that another description makes, too.
std::vector<PlantedBug> surface_bugs();
std::vector<CorrectPair> correct_pairs();

// The parts of `planted_bugs`, by where the mistake is.
std::vector<PlantedBug> method_bugs();
std::vector<PlantedBug> bsdf_bugs();
std::vector<PlantedBug> light_bugs();
std::vector<PlantedBug> pixel_bugs();
std::vector<PlantedBug> guided_bugs();

// Parts of `correct_pairs`: the same copies without a mistake, against the library. They show that it is the mistake
// that is found, and keep the copies in step with the library.
std::vector<CorrectPair> method_copies();
std::vector<CorrectPair> bsdf_copies();
std::vector<CorrectPair> light_copies();
std::vector<CorrectPair> pixel_copies();
std::vector<CorrectPair> guided_copies();

}  // namespace lightswitch::test
