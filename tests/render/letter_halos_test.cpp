// The halo of a text is made of copied letters. These tests compare this halo with the same text
// drawn as one path, which is slow and obvious.
#include "render/image/letter_halos.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <cairo.h>
#include <gtest/gtest.h>

#include "render/image/canvas.h"

namespace stormcellar::render {
namespace {

constexpr int halo_width = 160, halo_height = 40;

class Pen {
  public:
    Pen(const Fonts& fonts, double size) {
        cairo_set_font_face(context_, fonts.face(false));
        cairo_set_font_size(context_, size);
        cairo_font_options_t* options = cairo_font_options_create();
        cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_SLIGHT);
        cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_ON);
        cairo_set_font_options(context_, options);
        cairo_font_options_destroy(options);
    }
    Pen(const Pen&) = delete;
    Pen& operator=(const Pen&) = delete;
    ~Pen() {
        cairo_destroy(context_);
        cairo_surface_destroy(surface_);
    }

    [[nodiscard]] cairo_t* context() const { return context_; }
    [[nodiscard]] int at(int x, int y) const {
        cairo_surface_flush(surface_);
        return cairo_image_surface_get_data(
            surface_)[y * cairo_image_surface_get_stride(surface_) + x];
    }
    void draw_as_one_path(const std::string& text, int x, int y, double width) const {
        cairo_move_to(context_, x, y);
        cairo_text_path(context_, text.c_str());
        cairo_set_line_width(context_, width);
        cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
        cairo_stroke(context_);
    }
    void draw_copied(LetterHalos& halos, double size, const std::string& text, int x, int y,
                     double width) const {
        CoverMask mask =
            halos.halo_of(cairo_get_scaled_font(context_), false, size, text.c_str(), x, y, width);
        paint_cover(context_, mask);
    }

  private:
    cairo_surface_t* surface_ =
        cairo_image_surface_create(CAIRO_FORMAT_A8, halo_width, halo_height);
    cairo_t* context_ = cairo_create(surface_);
};

struct Difference {
    int most = 0;
    double mean = 0;  // over the pixels of the picture
    double covered = 0;
};

Difference difference_of(const std::string& text, double size, int x, int y) {
    const Fonts fonts = Fonts::load().value();
    const Pen slow(fonts, size), quick(fonts, size);
    LetterHalos halos;
    slow.draw_as_one_path(text, x, y, 2.5);
    quick.draw_copied(halos, size, text, x, y, 2.5);
    Difference difference;
    for (int row = 0; row < halo_height; ++row) {
        for (int column = 0; column < halo_width; ++column) {
            const int apart = std::abs(slow.at(column, row) - quick.at(column, row));
            difference.most = std::max(difference.most, apart);
            difference.mean += apart / double{halo_width * halo_height};
            difference.covered += slow.at(column, row) / (255.0 * halo_width * halo_height);
        }
    }
    return difference;
}

TEST(LetterHalos, OneLetterIsThePathItself) {
    for (const char* letter : {"L", "g", "8", "\u00B0"}) {
        const Difference difference = difference_of(letter, 10, 20, 20);
        EXPECT_GT(difference.covered, 0.004) << letter;
        EXPECT_LE(difference.most, 1) << letter;
    }
}

TEST(LetterHalos, AWordDiffersOnlyWhereTheOutlinesOfTwoLettersOverlap) {
    for (const double size : {8.5, 9.5, 10.5, 21.0}) {
        const Difference difference = difference_of("Wichita Falls", size, 5, 30);
        EXPECT_GT(difference.covered, 0.02) << size;
        EXPECT_LE(difference.most, 64) << size;
        EXPECT_LE(difference.mean, 0.25) << size;
    }
}

TEST(LetterHalos, EdgesOfThePictureCutIt) {
    for (const auto& [x, y] : {std::pair{-5, 20}, {152, 20}, {40, 4}, {40, 44}}) {
        const Difference difference = difference_of("N", 12, x, y);
        EXPECT_GT(difference.covered, 0.001) << x << " " << y;
        EXPECT_LE(difference.most, 1) << x << " " << y;
    }
    EXPECT_EQ(difference_of("N", 12, 400, 400).covered, 0);
}

TEST(LetterHalos, ATextWithoutLettersHasNone) {
    const Fonts fonts = Fonts::load().value();
    const Pen pen(fonts, 10);
    LetterHalos halos;
    for (const char* text : {"", "   "}) {
        const CoverMask mask =
            halos.halo_of(cairo_get_scaled_font(pen.context()), false, 10, text, 5, 5, 2);
        EXPECT_EQ(mask.width, 0);
    }
}

TEST(LetterHalos, SizesAndWeightsAreToldApart) {
    const auto fonts = Fonts::load();
    ASSERT_TRUE(fonts);
    Canvas canvas(80, 80, {0, 0, 0, 255});
    const Rgba8 white{255, 255, 255, 255}, red{255, 0, 0, 255};
    canvas.text(*fonts, "I", {10, 20}, 10, false, white, red);
    canvas.text(*fonts, "I", {40, 20}, 10, true, white, red);
    canvas.text(*fonts, "I", {10, 60}, 20, false, white, red);
    const Image image = canvas.image();
    const auto reddish = [&](int left, int top) {
        int count = 0;
        for (int y = top; y < top + 40; ++y) {
            for (int x = left; x < left + 30; ++x)
                count += image.at(x, y)[0] > image.at(x, y)[1] + 40 ? 1 : 0;
        }
        return count;
    };
    EXPECT_GT(reddish(0, 0), 10);
    EXPECT_GT(reddish(30, 0), reddish(0, 0)) << "a bold letter is wider";
    EXPECT_GT(reddish(0, 30), 1.5 * reddish(0, 0));
}

}  // namespace
}  // namespace stormcellar::render
