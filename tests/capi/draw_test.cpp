// Draws real volumes and grids by the C interface, and compares the files with those of
// `stormcellar frame`, byte for byte.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "tests/capi/opened.h"
#include "tests/testing/data.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::testing {
namespace {

struct FreePicture {
    void operator()(stormcellar_picture* picture) const { stormcellar_picture_free(picture); }
};
using OwnedPicture = std::unique_ptr<stormcellar_picture, FreePicture>;
using Settings = std::vector<std::string>;

// Options of a picture, for the C interface and for the command line.
struct Drawing {
    const char* file;
    const char* product;
    const char* moment = nullptr;
    Settings settings = {};
};

std::ostream& operator<<(std::ostream& stream, const Drawing& drawing) {
    return stream << drawing.product << " of " << drawing.file;
}

const char* const supercell = "volumes/KTLX19990503_235621.gz";
const char* const modern = "volumes/KLOT20220317_000842_V06";

stormcellar_draw_options options_of(const Drawing& drawing, std::vector<const char*>& settings) {
    stormcellar_draw_options options{};
    options.size = sizeof options;
    options.product = drawing.product;
    options.moment = drawing.moment;
    options.width = 400;
    options.height = 300;
    options.format = STORMCELLAR_PNG;
    for (const std::string& setting : drawing.settings)
        settings.push_back(setting.c_str());
    options.settings = settings.data();
    options.setting_count = static_cast<std::int32_t>(settings.size());
    return options;
}

std::string bytes_of(const OwnedPicture& picture) {
    auto facts = empty_facts<stormcellar_picture_facts>();
    const std::uint8_t* bytes = nullptr;
    EXPECT_EQ(stormcellar_picture_describe(picture.get(), &facts, nullptr), STORMCELLAR_OK);
    EXPECT_EQ(stormcellar_picture_bytes(picture.get(), &bytes, nullptr), STORMCELLAR_OK);
    EXPECT_EQ(facts.width, 400);
    EXPECT_EQ(facts.height, 300);
    return {bytes, bytes + facts.bytes};
}

std::string bytes_of_frame(const Drawing& drawing) {
    const TemporaryDirectory directory;
    const std::string file = directory.path() / "frame.png";
    std::vector<std::string> arguments{"frame",     real_file(drawing.file).string(),
                                       "-o",        file,
                                       "--product", drawing.product,
                                       "--width",   "400",
                                       "--height",  "300"};
    if (drawing.moment != nullptr) arguments.insert(arguments.end(), {"--moment", drawing.moment});
    for (const std::string& setting : drawing.settings)
        arguments.push_back("--" + setting);
    const ProgramResult drawn = run_program(STORMCELLAR_PROGRAM, arguments);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class CDraw : public ::testing::TestWithParam<Drawing> {};

TEST_P(CDraw, AVolumeGivesTheFileOfFrame) {
    STORMCELLAR_NEED_DATA();
    const Drawing& drawing = GetParam();
    const OpenedVolume volume = opened(real_file(drawing.file));
    std::vector<const char*> settings;
    const auto options = options_of(drawing, settings);
    stormcellar_picture* made = nullptr;
    stormcellar_error error{};
    ASSERT_EQ(stormcellar_volume_draw(volume.get(), &options, &made, &error), STORMCELLAR_OK)
        << error.message;
    EXPECT_TRUE(bytes_of(OwnedPicture(made)) == bytes_of_frame(drawing));
}

INSTANTIATE_TEST_SUITE_P(
    Products, CDraw,
    ::testing::Values(Drawing{supercell, "volume"},
                      Drawing{supercell, "ppi", "VEL", {"elevation=1.5"}},
                      Drawing{supercell, "ppi", "VEL", {"dealias=region", "time-zone=UTC"}},
                      Drawing{supercell, "composite", nullptr, {"theme=light", "no-labels"}},
                      Drawing{supercell, "cappi", "REF", {"height-km=3", "quality=0.5"}},
                      Drawing{supercell, "mesh", nullptr, {"freezing-levels=3800,6800"}},
                      Drawing{modern, "volume", "ZDR", {"azimuth=30", "tilt=40"}},
                      Drawing{modern, "mesh"}, Drawing{modern, "ppi", "HCA"}));

class CDrawOne : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        volume_ = opened(real_file(supercell));
        stormcellar_grid* made = nullptr;
        ASSERT_EQ(stormcellar_grid_make(volume_.get(), nullptr, &made, nullptr), STORMCELLAR_OK);
        grid_.reset(made);
    }
    stormcellar_code draw_grid() {
        stormcellar_picture* made = nullptr;
        const auto code = stormcellar_grid_draw(grid_.get(), &options_, &made, &error_);
        picture_.reset(made);
        return code;
    }
    stormcellar_code draw_volume() {
        stormcellar_picture* made = nullptr;
        const auto code = stormcellar_volume_draw(volume_.get(), &options_, &made, &error_);
        picture_.reset(made);
        return code;
    }
    OpenedVolume volume_;
    OwnedGrid grid_;
    OwnedPicture picture_;
    stormcellar_error error_{};
    std::vector<const char*> settings_;
    stormcellar_draw_options options_ = options_of({supercell, "composite"}, settings_);
};

TEST_F(CDrawOne, AGridGivesTheFileOfFrame) {
    ASSERT_EQ(draw_grid(), STORMCELLAR_OK) << error_.message;
    EXPECT_TRUE(bytes_of(picture_) == bytes_of_frame({supercell, "composite"}));
}

TEST_F(CDrawOne, PixelsAreInRowsFromTheTop) {
    options_.format = STORMCELLAR_RGBA;
    ASSERT_EQ(draw_grid(), STORMCELLAR_OK) << error_.message;
    const std::string dark = bytes_of(picture_);
    ASSERT_EQ(dark.size(), 400U * 300 * 4);
    settings_ = {"theme=light"};
    options_.settings = settings_.data();
    options_.setting_count = 1;
    ASSERT_EQ(draw_grid(), STORMCELLAR_OK) << error_.message;
    const std::string light = bytes_of(picture_);
    for (std::size_t alpha = 3; alpha < light.size(); alpha += 4)
        ASSERT_EQ(static_cast<unsigned char>(light[alpha]), 255);
    // The corners have the background color of the page.
    EXPECT_LT(static_cast<unsigned char>(dark[0]), 60);
    EXPECT_GT(static_cast<unsigned char>(light[0]), 200);
}

TEST_F(CDrawOne, WhatCannotBeDrawnIsRefused) {
    const auto refused = [&](auto change, stormcellar_code code = STORMCELLAR_BAD_ARGUMENT) {
        const stormcellar_draw_options usual = options_;
        change(options_);
        EXPECT_EQ(draw_volume(), code) << error_.message;
        EXPECT_EQ(picture_, nullptr);
        options_ = usual;
    };
    const auto set = [&](const char* setting) {
        return [this, setting](stormcellar_draw_options& options) {
            settings_ = {setting};
            options.settings = settings_.data();
            options.setting_count = 1;
        };
    };
    refused([](auto& options) { options.product = "radar"; });
    refused([](auto& options) { options.moment = "DBZ"; });
    refused([](auto& options) { options.width = -5; });
    refused([](auto& options) { options.format = 7; });
    refused([](auto& options) { options.threads = -1; });
    refused([](auto& options) { options.setting_count = 1; });
    refused([](auto& options) { options.product = "rain-total"; });
    refused([](auto& options) { options.moment = "ZDR"; }, STORMCELLAR_NOT_FOUND);
    refused(set(nullptr));
    refused(set("tint=red"));
    refused(set("fps=3"));
    refused(set("theme=purple"));
    refused(set("product=ppi"));
    refused(set("tilt=40"));
    refused(set("overlay=cells"), STORMCELLAR_UNSUPPORTED);
    options_.product = "ppi";
    EXPECT_EQ(draw_grid(), STORMCELLAR_BAD_ARGUMENT) << "a ppi needs a volume";
    EXPECT_EQ(stormcellar_volume_draw(nullptr, nullptr, nullptr, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_picture_bytes(nullptr, nullptr, nullptr), STORMCELLAR_BAD_ARGUMENT);
    stormcellar_picture_free(nullptr);
}

}  // namespace
}  // namespace stormcellar::testing
