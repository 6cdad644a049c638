#pragma once

// Everything but the loaders of scene files (see load/).

#include <lightswitch/compare/verify.hpp>
#include <lightswitch/film/image_io.hpp>
#include <lightswitch/render/any_method.hpp>
#include <lightswitch/render/render.hpp>
#include <lightswitch/scene/any_scene.hpp>
#include <lightswitch/scene/stock.hpp>
