#pragma once

// The options of each sub-command: what they are called, what they mean, and how they are read.

#include "program.hpp"

#include <CLI/CLI.hpp>

namespace lightswitch::program {

// Each adds one sub-command's options, with their help; reading them throws `Error`.
void add_scene_options(CLI::App& app, SceneOptions& options);
void add_render(CLI::App& app, RenderOptions& options);
void add_view(CLI::App& app, ViewOptions& options);
void add_merge(CLI::App& app, MergeOptions& options);
void add_compare(CLI::App& app, CompareOptions& options);
void add_verify(CLI::App& app, VerifyCommand& command);
void add_strategies(CLI::App& app, StrategiesCommand& command);
void add_replay(CLI::App& app, ReplayCommand& command);
void add_sweep(CLI::App& app, SweepCommand& command);

/// The options of renders that survive, may take long and run on several machines.
void add_long_options(CLI::App& app, RenderOptions& options);

/// `--output`, as images that are written. What is common to several commands.
void add_outputs(CLI::App& app, std::vector<std::filesystem::path>& outputs, const std::string& help);

/// How long paths become, and which random numbers they take: as `render` has it.
void add_path_options(CLI::App& app, std::optional<int>& max_depth, std::optional<int>& rr_depth, Sampling& sampling);

/// A path length, as --max-depth gives it.
int parse_max_depth(std::string_view text);

/// The options that only some methods have, as a group of their own.
void add_method_options(CLI::App& app, MethodOptions& options);

}  // namespace lightswitch::program
