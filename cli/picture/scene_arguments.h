// cli/picture/scene_arguments.h -- adds the options for the contents of a picture, which `frame`
// and `loop` share, to the command line.
#pragma once

#include "cli/shared/commands.h"
#include "render/options/option_text.h"
#include "render/options/picture_options.h"
#include "render/options/scene_options.h"

namespace stormcellar::cli {

// The table of the options of a picture is in render/options.
using render::frame_facts_of;
using render::LoopChoices;
using render::numbers_of;
using render::PictureOption;
using render::SceneOptions;

// Adds the options of product, colors, camera and labels to a subcommand, and --threads. `options`
// must outlive the parse.
void add_scene_options(CLI::App& app, SceneOptions& options);
// Adds the options that only `loop` has, which are the rows of [loop]. Both arguments must outlive
// the parse.
void add_loop_settings(CLI::App& app, SceneOptions& options, LoopChoices& loop);

}  // namespace stormcellar::cli
