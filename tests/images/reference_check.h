// tests/images/reference_check.h -- compares a picture with its stored reference.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::images {

// Reads tests/images/references/NAME.png.
[[nodiscard]] Result<render::Image> read_reference(const std::string& name);

// Succeeds if the picture equals its reference within the tolerance. If not, the message names a
// directory with the picture, the reference and their difference. With
// STORMCELLAR_UPDATE_REFERENCES set (scripts/update-image-references), a reference that differs or
// is missing is replaced by the picture.
[[nodiscard]] ::testing::AssertionResult matches_reference(const render::Image& picture,
                                                           const std::string& name);

}  // namespace stormcellar::images
