#include "render/color/color_file.h"

#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using level2::Moment;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace std::string_view_literals;

constexpr std::string_view blended = R"(; a table of reflectivity
Product: BR
Units:   DBZ
Step:    10
Color:      5   0   0 100   100 200  50   ; to its own second colour
COLOR:     15  10  20  30                 ; to the next entry's colour
solidcolor: 25 200 100   0
Color4:    45  40  60  80 255
Color:     65 255 255 255   1 2 3         ; the last: nothing to blend to
RF: 119 0 125
ND: 0 0 0
)";

TEST(PalFile, BlendsAsTheFormatSays) {
    const auto table = parse_pal(blended, "a.pal");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(table->moment, Moment::ref);
    EXPECT_EQ(table->unit, "dBZ");
    EXPECT_EQ(table->range_folded, (Rgba8{119, 0, 125, 255}));
    EXPECT_FALSE(is_stepped(*table));
    EXPECT_FALSE(color_of(*table, 4.9F));
    EXPECT_EQ(color_of(*table, 5), (Rgba8{0, 0, 100, 255}));
    EXPECT_EQ(color_of(*table, 10), (Rgba8{50, 100, 75, 255})) << "half way to the second entry";
    EXPECT_EQ(color_of(*table, 15), (Rgba8{10, 20, 30, 255}));
    EXPECT_EQ(color_of(*table, 20), (Rgba8{105, 60, 15, 255})) << "half way to the next entry";
    EXPECT_EQ(color_of(*table, 44.9F), (Rgba8{200, 100, 0, 255})) << "a solid color does not blend";
    EXPECT_EQ(color_of(*table, 50), (Rgba8{94, 109, 124, 255}))
        << "50 is a quarter of the way to the next entry";
    EXPECT_EQ(color_of(*table, 90), (Rgba8{255, 255, 255, 255}));
    EXPECT_EQ(table->end, 75);
    EXPECT_DOUBLE_EQ(extinction_per_m(*table, 40, 1), extinction_per_m(nws_reflectivity(), 40, 1));
}

TEST(PalFile, FallingValuesAreTheSameTable) {
    const auto rising = parse_pal("Color: 0 1 2 3\nColor: 10 4 5 6\nSolidColor: 20 7 8 9\n", "r");
    const auto falling = parse_pal("SolidColor: 20 7 8 9\nColor: 10 4 5 6\nColor: 0 1 2 3\n", "f");
    ASSERT_TRUE(rising && falling);
    ASSERT_EQ(rising->stops.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(rising->stops[i].from, falling->stops[i].from);
        EXPECT_EQ(rising->stops[i].color, falling->stops[i].color);
        EXPECT_EQ(rising->stops[i].until, falling->stops[i].until);
    }
}

// If two entries have one value, the entry below blends to the first of them, and the range above
// begins with the second.
TEST(PalFile, TwoEntriesAtOneValueMakeAnEdge) {
    const auto table = parse_pal(
        "Color: 0 0 0 0\nColor: 10 100 100 100\nColor: 10 0 0 200\nColor: 20 0 0 0\n", "e");
    ASSERT_TRUE(table) << table.error().message;
    ASSERT_EQ(table->stops.size(), 3U);
    EXPECT_EQ(color_of(*table, 5), (Rgba8{50, 50, 50, 255}));
    EXPECT_EQ(color_of(*table, 10), (Rgba8{0, 0, 200, 255}));
}

// A number w of the file is the value (w - offset) / scale.
TEST(PalFile, ScaleAndOffsetLeadBackToOurUnits) {
    const auto table = parse_pal(
        "Product: BV\nUnits: KTS\nScale: 2\nOffset: 1\nSolidColor: -39 0 255 0\n"
        "SolidColor: 1 9 9 9\nSolidColor: 41 255 0 0\n",
        "v.pal");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(table->moment, Moment::vel);
    EXPECT_EQ(table->unit, "m/s");
    EXPECT_EQ(table->stops[0].from, -20);
    EXPECT_EQ(table->stops[1].from, 0);
    EXPECT_EQ(table->stops[2].from, 20);
    EXPECT_TRUE(is_stepped(*table));
    EXPECT_DOUBLE_EQ(extinction_per_m(*table, -10, 1) * 1000, 0.03);
}

TEST(PalFile, UnitsAreConvertedWithoutAScale) {
    const auto knots = parse_pal("Units: KT\nColor: 0 0 0 0\nColor: 100 255 0 0\n", "k");
    ASSERT_TRUE(knots);
    EXPECT_EQ(knots->moment, Moment::vel);
    EXPECT_NEAR(knots->stops[1].from, 51.4444, 1e-4) << "1 kt = 1852 m / 3600 s";
    const auto feet = parse_pal("Product: ET\nUnits: kft\nColor: 10 0 0 0\nColor: 50 1 1 1\n", "f");
    ASSERT_TRUE(feet);
    EXPECT_EQ(feet->unit, "km");
    EXPECT_NEAR(feet->stops[1].from, 15.24, 1e-5);
    const auto percent =
        parse_pal("Product: CC\nUnits: %\nColor: 20 0 0 0\nColor: 99 1 1 1\n", "c");
    ASSERT_TRUE(percent);
    EXPECT_EQ(percent->unit, "");
    EXPECT_NEAR(percent->stops[1].from, 0.99, 1e-6);
    const auto other = parse_pal("Product: XYZ\nUnits: mm/h\nColor: 20 0 0 0\n", "o");
    ASSERT_TRUE(other);
    EXPECT_EQ(other->unit, "mm/h");
    EXPECT_EQ(other->stops.front().from, 20);
}

TEST(PalFile, AlphaFadesInVolumesToo) {
    const auto table = parse_pal(
        "Product: BR\nSolidColor4: 0 9 9 9 0\nSolidColor4: 20 9 9 9 51\nSolidColor: 40 9 9 9\n",
        "a");
    ASSERT_TRUE(table);
    EXPECT_EQ(extinction_per_m(*table, 10, 1), 0);
    EXPECT_DOUBLE_EQ(extinction_per_m(*table, 30, 1),
                     extinction_per_m(nws_reflectivity(), 30, 1) / 5);
    EXPECT_DOUBLE_EQ(extinction_per_m(*table, 50, 1), extinction_per_m(nws_reflectivity(), 50, 1));
}

TEST(PalFile, ErrorsNameTheLine) {
    const auto message = [](std::string_view text) {
        const auto table = parse_pal(text, "t.pal");
        return table ? std::string{} : table.error().message;
    };
    for (const auto& [text, begin] : {std::pair{"Color: 1 2 3 4\nbogus\n", "2: 'bogus'"},
                                      {"Colr: 1 2 3 4\n", "1: unknown key 'COLR'"},
                                      {"\n\nColor: 1 2 3\n", "3: there must be a value and 3 or 6"},
                                      {"Color: 1 2 3 256\n", "1: '256' is not a color"},
                                      {"Color: 1 2 -3 4\n", "1: '-3'"},
                                      {"Color: nan 2 3 4\n", "1: 'nan'"},
                                      {"Color: 1e9 2 3 4\n", "1: '1e9'"},
                                      {"Scale: 0\n", "1: the number must be above 0"},
                                      {"Scale: -1\n", "1: the number must be above 0"},
                                      {"RF: 1\n", "1: there must be red"}})
        EXPECT_THAT(message(text), StartsWith("t.pal:" + std::string(begin)));
    EXPECT_THAT(message(""), HasSubstr("no Color:"));
    EXPECT_THAT(message("; nothing\n"), HasSubstr("no Color:"));
    std::string many;
    for (int i = 0; i < 5000; ++i)
        many += "Color: " + std::to_string(i) + " 0 0 0\n";
    EXPECT_THAT(message(many), StartsWith("t.pal:4097: there are more than 4096"));
    EXPECT_THAT(message("Color: 1 2 3 4\n\x1b[31mX: 1\n"), ::testing::Not(HasSubstr("\x1b")));
}

constexpr std::string_view toml_example = R"(
name = "mine"
moment = "VEL"
[[point]]
value = -30
colour = "#0000ff"
opacity_per_km = 0.2
[[point]]
value = 0.0
colour = [100, 100, 100, 51]
opacity_per_km = 0
[[point]]
value = 30
colour = "#ff000080"
opacity_per_km = 0.4
)";

TEST(TomlColors, BlendFromPointToPoint) {
    const auto table = parse_toml_colors(toml_example, "t.toml");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(table->name, "mine");
    EXPECT_EQ(table->moment, Moment::vel);
    EXPECT_EQ(table->unit, "m/s");
    EXPECT_EQ(color_of(*table, -30), (Rgba8{0, 0, 255, 255}));
    EXPECT_EQ(color_of(*table, -15), (Rgba8{50, 50, 178, 153}));
    EXPECT_EQ(color_of(*table, 99), (Rgba8{255, 0, 0, 128}));
    EXPECT_EQ(table->end, 60);
    EXPECT_DOUBLE_EQ(extinction_per_m(*table, 15, 1) * 1000, 0.2);
}

TEST(TomlColors, ColorIsSpelledEitherWay) {
    std::string american(toml_example);
    for (std::size_t at = american.find("colour"); at != std::string::npos;
         at = american.find("colour", at))
        american.replace(at, 6, "color");
    const auto table = parse_toml_colors(american, "t.toml");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(color_of(*table, 99), color_of(*parse_toml_colors(toml_example, "t.toml"), 99));
    const auto both = parse_toml_colors(
        "[[point]]\nvalue = 1\ncolor = \"#000000\"\ncolour = \"#000000\"\n"
        "[[point]]\nvalue = 2\ncolor = \"#ffffff\"\n",
        "t.toml");
    ASSERT_FALSE(both);
    EXPECT_EQ(both.error().message, "t.toml:4: unknown key [point] colour");
}

// One table may have blends, classes and edges, as a .pal may.
TEST(TomlColors, APointMayBlendToAColorOfItsOwn) {
    const auto table = parse_toml_colors(
        "moment = \"REF\"\n"
        "[[point]]\nvalue = 10\ncolor = \"#000000\"\nuntil = \"#646464\"\n"
        "[[point]]\nvalue = 20\ncolor = \"#0000c8\"\nuntil = \"#0000c8\"\n"
        "[[point]]\nvalue = 30\ncolor = \"#c80000\"\n"
        "[[point]]\nvalue = 40\ncolor = \"#ffffff\"\n",
        "t.toml");
    ASSERT_TRUE(table) << table.error().message;
    const auto pal = parse_pal(
        "Product: BR\nColor: 10 0 0 0 100 100 100\nSolidColor: 20 0 0 200\n"
        "Color: 30 200 0 0\nColor: 40 255 255 255\n",
        "t.pal");
    ASSERT_TRUE(pal) << pal.error().message;
    EXPECT_EQ(table->stops, pal->stops);
    EXPECT_EQ(color_of(*table, 15), (Rgba8{50, 50, 50, 255}));
    EXPECT_EQ(color_of(*table, 29.9F), (Rgba8{0, 0, 200, 255}));
    const auto stepped = parse_toml_colors(
        "stepped = true\n[[point]]\nvalue = 1\ncolor = \"#000000\"\nuntil = \"#ffffff\"\n", "t");
    ASSERT_FALSE(stepped);
    EXPECT_EQ(stepped.error().message,
              "t:5: [point] until: has no meaning where colors are stepped");
}

TEST(TomlColors, ASteppedTableHasClassesAndTheMomentsOpacity) {
    const auto table = parse_toml_colors(
        "moment = \"REF\"\nstepped = true\nend = 60\nrange_folded = \"#010203\"\n"
        "[[point]]\nvalue = 10\ncolour = \"#102030\"\n[[point]]\nvalue = 50\ncolour = "
        "\"#405060\"\n",
        "t.toml");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_TRUE(is_stepped(*table));
    EXPECT_EQ(color_of(*table, 49), (Rgba8{0x10, 0x20, 0x30, 255}));
    EXPECT_EQ(table->end, 60);
    EXPECT_EQ(table->range_folded, (Rgba8{1, 2, 3, 255}));
    EXPECT_DOUBLE_EQ(extinction_per_m(*table, 45, 1), extinction_per_m(nws_reflectivity(), 45, 1));
}

TEST(TomlColors, ErrorsNameLineAndKey) {
    const auto message = [](const std::string& text) {
        const auto table = parse_toml_colors(text, "t.toml");
        return table ? std::string{} : table.error().message;
    };
    const std::string two =
        "[[point]]\nvalue = 1\ncolour = \"#000000\"\n"
        "[[point]]\nvalue = 2\ncolour = \"#ffffff\"\n";
    EXPECT_EQ(message(two), "");
    const std::string point = "[[point]]\nvalue = ";
    const std::string black = "\ncolour = \"#000000\"\n";
    for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
             {"moment = \"RAIN\"\n" + two, "t.toml:1: moment"},
             {"unit = \"kt\"\nmoment = \"VEL\"\n" + two, "t.toml:1: unit"},
             {"stepped = 1\n" + two, "stepped: must be true or false"},
             {"colour = 1\n" + two, "unknown key"},
             {two + "opacity_per_km = 1\n", "for all points or for none"},
             {two + point + "2" + black, "t.toml:8: "},
             {two + point + "3\ncolour = \"#00000\"\n", "t.toml:9: "},
             {two + point + "3\ncolour = [1, 2, 256]\n", "colour"},
             {two + point + "nan" + black, "out of range"},
             {two + "[[point]]" + black, "is missing"},
             {"end = 2\n" + two, "t.toml:1: end"},
             {point + "1" + black, "2 to 4096"},
             {"point = 7\n", "point"}})
        EXPECT_THAT(message(text), HasSubstr(part)) << text;
}

// Expects that a file of any bytes gives an error of one line or a table that validate() accepts.
template <class Parse>
void expect_sound_for_mutations(std::string_view seed, const Parse& parse) {
    std::mt19937 random(20261122);
    std::uniform_int_distribution<std::size_t> any(0, 1U << 30U);
    constexpr std::string_view spice = "0123456789-+.e:;#\n\" []=,nanCSolidcolor4\0\x80\xff"sv;
    int accepted = 0;
    for (int round = 0; round < 4000; ++round) {
        std::string text(seed);
        for (std::size_t change = any(random) % 6; change < 6; ++change) {
            const std::size_t at = any(random) % text.size();
            switch (any(random) % 4) {
                case 0:
                    text[at] = spice[any(random) % spice.size()];
                    break;
                case 1:
                    text.erase(at, 1 + any(random) % 9);
                    break;
                case 2:
                    text.insert(at, text.substr(any(random) % text.size(), any(random) % 30));
                    break;
                default:
                    text.insert(at, 1, spice[any(random) % spice.size()]);
            }
            if (text.empty()) text = "x";
        }
        const auto table = parse(text);
        if (table) {
            ++accepted;
            ASSERT_TRUE(validate(*table)) << text;
            for (float v = -80; v < 120; v += 7.3F) {
                (void)color_of(*table, v);
                ASSERT_GE(extinction_per_m(*table, static_cast<double>(v), 1), 0);
            }
        } else {
            ASSERT_EQ(table.error().code, ErrorCode::bad_argument);
            ASSERT_THAT(table.error().message, StartsWith("m:"));
            ASSERT_EQ(table.error().message.find('\n'), std::string::npos) << text;
        }
    }
    EXPECT_GT(accepted, 20) << "mutations that always fail test little";
}

TEST(PalFile, MutationsAreTablesOrErrors) {
    expect_sound_for_mutations(blended, [](const std::string& t) { return parse_pal(t, "m"); });
}

TEST(TomlColors, MutationsAreTablesOrErrors) {
    expect_sound_for_mutations(toml_example,
                               [](const std::string& t) { return parse_toml_colors(t, "m"); });
}

TEST(ColorsFrom, TheShippedFilesAreTables) {
    const auto scenes = testing::source_directory() / "scenes";
    const auto storm = colors_from(scenes / "storm-colours.toml");
    ASSERT_TRUE(storm) << storm.error().message;
    EXPECT_EQ(color_of(*storm, 52), color_of(nws_reflectivity(), 52));
    const auto clear = colors_from(scenes / "clear-air-colours.toml");
    ASSERT_TRUE(clear) << clear.error().message;
    EXPECT_EQ(clear->moment, Moment::ref);
    EXPECT_TRUE(is_stepped(*clear));
    EXPECT_FALSE(color_of(*clear, -28.5F));
    EXPECT_EQ(color_of(*clear, -28), (Rgba8{0x3b, 0x38, 0x42, 255}));
    EXPECT_EQ(color_of(*clear, 40), (Rgba8{0xd8, 0x28, 0x2c, 255})) << "the last class is open";
}

TEST(ColorsFrom, TakesANameOrAFile) {
    const testing::TemporaryDirectory directory;
    std::ofstream(directory / "mine.PAL") << blended;
    std::ofstream(directory / "wind.toml") << toml_example;
    EXPECT_EQ(colors_from("safe-velocity")->name, "safe-velocity");
    EXPECT_EQ(colors_from((directory / "mine.PAL").string())->name, "mine");
    EXPECT_EQ(colors_from((directory / "wind.toml").string())->name, "mine");
    const auto unknown = colors_from("rainbow");
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(unknown.error().message, HasSubstr("safe-velocity"));
    EXPECT_EQ(colors_from((directory / "none.pal").string()).error().code, ErrorCode::not_found);
    EXPECT_EQ(read_color_file(directory / "x.csv").error().code, ErrorCode::bad_argument);
    std::ofstream(directory / "large.pal") << std::string(std::size_t{1} << 21U, '\n');
    EXPECT_FALSE(colors_from((directory / "large.pal").string()));
}

}  // namespace
}  // namespace stormcellar::render
