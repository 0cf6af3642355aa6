// web/data/pictures/picture_query.h -- the options of a picture in the query of an address.
//
// A parameter is an option of `stormcellar frame` without its dashes ("tilt", "camera-km"), out of
// the same table (render/options/picture_options.h). Options that are not about the picture
// (threads) are no parameters, and colors are taken by name only: a query never names a file.
//
// Threads   Pure functions.
// Errors    bad_argument, naming the parameter, for one that is not known, is given twice, has more
//           than 256 bytes or a value that makes no sense.
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
    std::string key;  // what was asked, in one order: for kept answers
};

using TakesOption = bool (*)(const render::PictureOption&);
// Returns true for every option of a picture.
[[nodiscard]] bool is_of_frames(const render::PictureOption& option);
// Returns true for options that apply to a bare map: not its product, size, theme and labels.
[[nodiscard]] bool is_of_bare_maps(const render::PictureOption& option);

// Reads the options that `takes` allows. `others` are parameters that the door itself reads.
[[nodiscard]] Result<PictureQuery> picture_query(const Fields& query, TakesOption takes,
                                                 std::span<const std::string_view> others);

// Returns the parameters of these options, for lists and messages.
[[nodiscard]] std::string parameters_for_help(TakesOption takes);

}  // namespace stormcellar::web
