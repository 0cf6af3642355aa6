// tests/web/library_picture.h -- draws pictures with the library, for comparison with the pictures
// of the data server.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "render/options/still_frame.h"
#include "stormcellar/render/still.h"

namespace stormcellar::web {

// Returns the options of a picture of 400 x 300 pixels whose labels are in UTC.
inline render::SceneOptions small_picture(const std::string& product) {
    render::SceneOptions options;
    options.product = product;
    options.time_zone = "UTC";
    options.scene.width = 400;
    options.scene.height = 300;
    return options;
}

// Returns the bytes of a file of this name.
inline std::string library_picture(const render::StillSource& still, const std::string& name) {
    auto scene = render::scene_of(still.options);
    EXPECT_TRUE(scene) << still.options.product;
    EXPECT_TRUE(render::fit_to_grid(still, *scene)) << still.options.product;
    const auto bytes = render::encode_still(still, *scene,
                                            {.format = *render::still_format_of(name),
                                             .tiff = render::TiffContent::values,
                                             .error = {},
                                             .threads = 1,
                                             .drawn = {}});
    EXPECT_TRUE(bytes) << name;
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

}  // namespace stormcellar::web
