#pragma once

// What it takes to render and save images of scenes made in code or in stock. Loaders of scene files are in load/,
// comparisons in compare/, verify/ and report/.

#include <lightswitch/film/image_io.hpp>
#include <lightswitch/method/any_method.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>
#include <lightswitch/scene/stock.hpp>
