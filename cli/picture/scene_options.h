// cli/picture/scene_options.h -- puts the options for the contents of a picture, which `frame` and
// `loop` share, on the command line.
#pragma once

#include "render/options/option_text.h"
#include "render/options/picture_options.h"
#include "render/options/scene_options.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

// The options of a picture have their own room (render/options).
using render::frame_facts_of;
using render::LoopChoices;
using render::numbers_of;
using render::PictureOption;
using render::SceneOptions;

// Adds the options of product, colors, camera and labels to a subcommand, and --threads. `options`
// must outlive the parse.
void add_scene_options(CLI::App& app, SceneOptions& options);
// Puts those of `loop` alone on it: the rows of [loop]. Both must outlive the parse.
void add_loop_settings(CLI::App& app, SceneOptions& options, LoopChoices& loop);

}  // namespace stormcellar::cli
