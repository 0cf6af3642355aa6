// web/data/pictures/picture_query.h -- reads the options of a picture from the query of an address.
//
// A parameter is an option of `stormcellar frame` without its dashes ("tilt", "camera-km"), from
// the same table (render/options/picture_options.h). Options that do not affect the picture
// (threads) are not parameters. Colors are given by name only, so that a query never names a file.
//
// Threads   Pure functions.
// Errors    bad_argument, naming the parameter, if it is unknown, comes twice, has more than 256
//           bytes, or has a value that makes no sense.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "render/options/scene_options.h"
#include "stormcellar/base/result.h"
#include "web/http/request.h"

namespace stormcellar::web {

struct PictureQuery {
    render::SceneOptions options;
    std::string key;  // the query in a fixed order, for keys of kept answers
};

using TakesOption = bool (*)(const render::PictureOption&);
// Returns true for every option of a picture. The only overlay is "cells".
[[nodiscard]] bool is_of_frames(const render::PictureOption& option);
// Returns true for options that apply to a bare map: all but product, size, theme, overlay and
// labels.
[[nodiscard]] bool is_of_bare_maps(const render::PictureOption& option);

// Reads the options that `takes` allows. Ignores parameters named in `others`, which the caller
// reads.
[[nodiscard]] Result<PictureQuery> picture_query(const Fields& query, TakesOption takes,
                                                 std::span<const std::string_view> others);

// Returns the names of the parameters for these options, for lists and messages.
[[nodiscard]] std::string parameters_for_help(TakesOption takes);

}  // namespace stormcellar::web
