#include "render/color/built_in_tables.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/name_list.h"
#include "render/image/unknown_name.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

// Classes without a lower bound begin here, below every value that a radar sends. The limit is not
// lower still, because a volume sorts the values from here on into 256 bins.
constexpr float least_velocity = -64;
constexpr float least_zdr = -13;
constexpr float least_height = -10;

struct ColorClass {
    float from;
    std::uint32_t rgb;
};

Rgba8 rgba_of(std::uint32_t rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16U), static_cast<std::uint8_t>(rgb >> 8U & 0xFFU),
            static_cast<std::uint8_t>(rgb & 0xFFU), 255};
}

constexpr ColorClass nws_reflectivity_classes[] = {
    {5, 0x04E9E7},  {10, 0x019FF4}, {15, 0x0300F4}, {20, 0x02FD02}, {25, 0x01C501},
    {30, 0x008E00}, {35, 0xFDF802}, {40, 0xE5BC00}, {45, 0xFD9500}, {50, 0xFD0000},
    {55, 0xD40000}, {60, 0xBC0000}, {65, 0xF800FD}, {70, 0x9854C6}, {75, 0xFDFDFD},
};

constexpr ColorClass nws_velocity_classes[] = {
    {least_velocity, 0x02FC02},
    {-33, 0x01E401},
    {-25.5, 0x01C501},
    {-18.5, 0x07AC04},
    {-13.5, 0x068F03},
    {-10, 0x047202},
    {-5, 0x7C977B},
    {-0.5, 0x808080},
    {0.5, 0x987777},
    {5, 0x890000},
    {10, 0xA20000},
    {13.5, 0xB90000},
    {18.5, 0xD80000},
    {25.5, 0xEF0000},
    {33, 0xFE0000},
};

constexpr ColorClass nws_spectrum_width_classes[] = {{0, 0x767676}, {2, 0x9C9C9C}, {4, 0x00BB00},
                                                     {6, 0xFF0000}, {8, 0xD07000}, {10, 0xFFFF00}};

constexpr ColorClass nws_zdr_classes[] = {
    {least_zdr, 0x404040}, {-2, 0x9C9C9C}, {-0.5, 0xC9C9C9}, {0, 0x8C78B4}, {0.25, 0x000098},
    {0.5, 0x2398D3},       {1, 0x44FFD2},  {1.5, 0x57DB56},  {2, 0xFFFF60}, {2.5, 0xFF9045},
    {3, 0xDA0000},         {4, 0xAE0000},  {5, 0xF782BE},    {6, 0xFFFFFF},
};

constexpr ColorClass nws_rho_classes[] = {
    {0.2F, 0x95949C},  {0.45F, 0x16148C}, {0.65F, 0x0902D9}, {0.75F, 0x8987D6}, {0.8F, 0x5CFF59},
    {0.85F, 0x8BCF02}, {0.9F, 0xFFFB00},  {0.93F, 0xFFC400}, {0.95F, 0xFF8903}, {0.96F, 0xFF2B00},
    {0.97F, 0xE30000}, {0.98F, 0xA10000}, {0.99F, 0x970556}, {1, 0xFAACD1},
};

constexpr ColorClass nws_echo_top_classes[] = {
    {0, 0x4C4C4C},   {1.5, 0x767676},  {3, 0x00E0FF},    {4.5, 0x00B0FF},  {6, 0x0090CC},
    {7.5, 0x320096}, {9, 0x00FB90},    {10.5, 0x00BB00}, {12, 0x00EF00},   {13.5, 0xFEBF00},
    {15, 0xFFFF00},  {16.5, 0xAE0000}, {18, 0xFF0000},   {19.5, 0xFFFFFF}, {21, 0xE700FF},
};

constexpr ColorClass nws_vil_classes[] = {
    {1, 0x9C9C9C},  {5, 0x767676},  {10, 0xFFAAAA}, {15, 0xEE8C8C}, {20, 0xC97070},
    {25, 0x00FB90}, {30, 0x00BB00}, {35, 0xFFFF70}, {40, 0xD0D060}, {45, 0xFF6060},
    {50, 0xDA0000}, {55, 0xAE0000}, {60, 0x0000FF}, {65, 0xFFFFFF}, {70, 0xE700FF},
};

constexpr ColorClass phi_classes[] = {
    {0, 0x6A3D9A},   {30, 0x3F51B5},  {60, 0x1E88E5},  {90, 0x00ACC1},
    {120, 0x00897B}, {150, 0x43A047}, {180, 0x9CCC65}, {210, 0xFFEB3B},
    {240, 0xFFB300}, {270, 0xFB6A1A}, {300, 0xE53935}, {330, 0xAD1457},
};

constexpr ColorClass cfp_classes[] = {
    {0, 0x4A4A4A},  {5, 0x8C8C8C},  {10, 0x5B7FBF}, {15, 0x2F9CD8}, {20, 0x2EC4A6}, {25, 0x6FD24B},
    {30, 0xD9D93B}, {35, 0xF2A93B}, {40, 0xEE6C2D}, {45, 0xD62F2F}, {50, 0xF2C1E0},
};

// The colors go from dark blue to light yellow, because every kind of color vision distinguishes
// light from dark and blue from yellow. The steps between them are about equal along a path through
// Lab.
constexpr ColorClass height_classes[] = {
    {least_height, 0x003482},
    {0.5, 0x144D94},
    {1, 0x27649E},
    {1.5, 0x3379A8},
    {2, 0x658799},
    {3, 0x798D8F},
    {4, 0x899386},
    {5, 0x98997B},
    {6, 0xAAA26D},
    {8, 0xC0AD58},
    {10, 0xDEC44F},
    {12, 0xFFE170},
    {15, 0xFFEEBE},
    {18, 0xFFF9ED},
};

constexpr ColorClass vil_density_classes[] = {
    {0.25, 0x6C7A89}, {0.5, 0x4F7FB5}, {1, 0x2FA4D8}, {1.5, 0x35C3A0},
    {2, 0x43B649},    {2.5, 0xA5CF3B}, {3, 0xFFDC3C}, {3.5, 0xFF5A36},
    {4, 0xD41F3A},    {4.5, 0xA3123F}, {5, 0xD64BC8}, {6, 0xF4C6F2},
};

constexpr ColorClass rain_total_classes[] = {{0.2F, 0x3B4A6B}, {1, 0x3A5F9E},   {2.5F, 0x2F7FCB},
                                             {5, 0x2AA0B8},    {10, 0x36B384},  {15, 0x63C05A},
                                             {25, 0xB4CC3E},   {40, 0xEBCB35},  {60, 0xF29A2E},
                                             {80, 0xE85A34},   {100, 0xC9294F}, {150, 0xD56AD0}};

constexpr ColorClass hail_size_classes[] = {
    {5, 0x6C7A89},  {10, 0x4F7FB5}, {15, 0x2FA4D8},  {20, 0x35C3A0},
    {25, 0x43B649}, {30, 0xA5CF3B}, {40, 0xFFDC3C},  {50, 0xFF9A2E},
    {60, 0xFF5A36}, {75, 0xD41F3A}, {100, 0xD64BC8}, {125, 0xF4C6F2},
};

constexpr ColorClass hail_probability_classes[] = {
    {10, 0x6C7A89}, {20, 0x4F7FB5}, {30, 0x2FA4D8}, {40, 0x35C3A0}, {50, 0x43B649},
    {60, 0xA5CF3B}, {70, 0xFFDC3C}, {80, 0xFF9A2E}, {90, 0xFF5A36}, {100, 0xD64BC8},
};

// The bounds are the SHI of hail of 5, 10, 15 ... mm, so that maps of SHI and of hail size look
// alike.
constexpr ColorClass hail_index_classes[] = {
    {4, 0x6C7A89},   {16, 0x4F7FB5},  {35, 0x2FA4D8},   {62, 0x35C3A0},
    {97, 0x43B649},  {140, 0xA5CF3B}, {248, 0xFFDC3C},  {388, 0xFF9A2E},
    {558, 0xFF5A36}, {872, 0xD41F3A}, {1550, 0xD64BC8}, {2422, 0xF4C6F2},
};

// Each class begins between two numbers of the moment HCA.
constexpr ColorClass hydrometeor_classes[] = {
    {5, 0x8A8A8A},  {15, 0x4A4A4A}, {25, 0xF2B8D8}, {35, 0x8FE3FF}, {45, 0x2F7FF0},
    {55, 0x35C95A}, {65, 0x0B7A2E}, {75, 0xD8B45A}, {85, 0xE04BE0}, {95, 0xE8202A},
};

constexpr ColorClass safe_reflectivity_classes[] = {
    {5, 0x003482},  {10, 0x114B94}, {15, 0x26619E}, {20, 0x3175A6}, {25, 0x60869C},
    {30, 0x758C92}, {35, 0x859189}, {40, 0x929780}, {45, 0xA29E74}, {50, 0xB5A763},
    {55, 0xCFB851}, {60, 0xEDD04C}, {65, 0xFFE487}, {70, 0xFFF0C7}, {75, 0xFEFAF3},
};

// Blue is toward the radar, orange is away from it, and gray is at rest. Faster echo is lighter.
constexpr ColorClass safe_velocity_classes[] = {
    {least_velocity, 0xC4EFFF},
    {-33, 0x8FD7FE},
    {-25.5, 0x42B0F1},
    {-18.5, 0x4892C8},
    {-10, 0x55799F},
    {-5, 0x606C7C},
    {-0.5, 0x636363},
    {0.5, 0x846659},
    {5, 0xAB694A},
    {10, 0xCF793C},
    {18.5, 0xF69A39},
    {25.5, 0xFFC972},
    {33, 0xFFE6B0},
};

constexpr ColorClass safe_zdr_classes[] = {
    {least_zdr, 0x013288}, {-2, 0x474B8C}, {-0.5, 0x5D5B8A}, {0, 0x716786}, {0.25, 0x846E7F},
    {0.5, 0x957478},       {1, 0xAA7D6F},  {1.5, 0xC38862},  {2, 0xDA9D58}, {2.5, 0xF9B947},
    {3, 0xFFD07D},         {4, 0xFFE1A8},  {5, 0xFFEFCB},    {6, 0xFFFBEA},
};

constexpr ColorClass safe_rho_classes[] = {
    {0.2F, 0x013288},  {0.45F, 0x494D8C}, {0.65F, 0x605E8A}, {0.75F, 0x766984}, {0.8F, 0x8A707D},
    {0.85F, 0x9E7875}, {0.9F, 0xB78369},  {0.93F, 0xD2955C}, {0.95F, 0xEDAE4E}, {0.96F, 0xFFCE75},
    {0.97F, 0xFFE0A5}, {0.98F, 0xFFEFCB}, {0.99F, 0xFFFBEB},
};

// A table of classes without blending. A table without a moment is never drawn as a volume.
struct SteppedTable {
    std::string_view name;
    std::optional<Moment> moment;
    std::string_view unit;  // if there is no moment
    std::span<const ColorClass> classes;
    float end;  // where the last class ends in a color bar
    std::optional<float> bar_begin = std::nullopt;
};
constexpr std::array stepped_tables{
    SteppedTable{"nws-reflectivity", Moment::ref, {}, nws_reflectivity_classes, 80},
    SteppedTable{"nws-velocity", Moment::vel, {}, nws_velocity_classes, 40, -40.0F},
    SteppedTable{"nws-spectrum-width", Moment::sw, {}, nws_spectrum_width_classes, 12},
    SteppedTable{"nws-zdr", Moment::zdr, {}, nws_zdr_classes, 8, -4.0F},
    SteppedTable{"nws-rho", Moment::rho, {}, nws_rho_classes, 1.05F},
    SteppedTable{"nws-echo-top", {}, "km", nws_echo_top_classes, 22.5},
    SteppedTable{"nws-vil", {}, "kg/m2", nws_vil_classes, 75},
    SteppedTable{"phi", Moment::phi, {}, phi_classes, 360},
    SteppedTable{"cfp", Moment::cfp, {}, cfp_classes, 55},
    SteppedTable{"height", {}, "km", height_classes, 20, 0.0F},
    SteppedTable{"water-density", {}, "g/m3", vil_density_classes, 7},
    SteppedTable{"hail-size", {}, "mm", hail_size_classes, 150},
    SteppedTable{"hail-probability", {}, "%", hail_probability_classes, 110},
    SteppedTable{"hail-index", {}, "J/m/s", hail_index_classes, 3500},
    SteppedTable{"rain-depth", {}, "mm", rain_total_classes, 200},
    SteppedTable{"hydrometeors", Moment::hca, {}, hydrometeor_classes, 105},
    SteppedTable{"safe-reflectivity", Moment::ref, {}, safe_reflectivity_classes, 80},
    SteppedTable{"safe-velocity", Moment::vel, {}, safe_velocity_classes, 40, -40.0F},
    SteppedTable{"safe-zdr", Moment::zdr, {}, safe_zdr_classes, 8, -4.0F},
    SteppedTable{"safe-rho", Moment::rho, {}, safe_rho_classes, 1.05F},
};

ColorTable table_of_classes(const SteppedTable& stepped) {
    ColorTable table;
    table.name = stepped.name;
    table.moment = stepped.moment.value_or(Moment::ref);
    table.unit = stepped.moment ? unit_of(*stepped.moment) : std::string(stepped.unit);
    table.end = stepped.end;
    table.bar_begin = stepped.bar_begin;
    table.range_folded = usual_range_folded;
    for (const ColorClass& one : stepped.classes) {
        const Rgba8 color = rgba_of(one.rgb);
        table.stops.push_back({one.from, color, color});
    }
    table.extinction = {{table.lowest(), 0}};
    if (stepped.moment) table.extinction = default_extinction(*stepped.moment, table.lowest());
    return table;
}

// Returns the table with this name. It must exist: tests look up each name that this file and the
// rows of moments use.
const ColorTable& table_named(std::string_view name) {
    return *std::ranges::find(built_in_tables(), name, &ColorTable::name);
}

}  // namespace

const std::vector<ColorTable>& built_in_tables() {
    static const std::vector<ColorTable> tables = [] {
        std::vector<ColorTable> made;
        for (const SteppedTable& stepped : stepped_tables)
            made.push_back(table_of_classes(stepped));
        const std::vector<ColorTable> smooth = make_smooth_tables();
        made.insert(made.end(), smooth.begin(), smooth.end());
        return made;
    }();
    return tables;
}

Result<ColorTable> find_color_table(std::string_view name) {
    std::vector<std::string> names;
    for (const ColorTable& table : built_in_tables()) {
        if (table.name == name) return table;
        names.push_back(table.name);
    }
    return unknown_name("color table", name, names, "tables are " + names_in(built_in_tables()),
                        ErrorCode::not_found);
}

const ColorTable& nws_reflectivity() {
    return table_named("nws-reflectivity");
}
const ColorTable& echo_top_colors() {
    return table_named("nws-echo-top");
}
const ColorTable& vil_colors() {
    return table_named("nws-vil");
}
const ColorTable& height_colors() {
    return table_named("height");
}
const ColorTable& vil_density_colors() {
    return table_named("water-density");
}
const ColorTable& hail_size_colors() {
    return table_named("hail-size");
}
const ColorTable& hail_probability_colors() {
    return table_named("hail-probability");
}
const ColorTable& hail_index_colors() {
    return table_named("hail-index");
}
const ColorTable& rain_total_colors() {
    return table_named("rain-depth");
}
const ColorTable& clear_air_colors() {
    return table_named("smooth-clear-air");
}

const ColorTable& default_color_table(Moment moment) {
    return table_named(look_of(moment).classes);
}
const ColorTable& smooth_color_table(Moment moment) {
    return table_named(look_of(moment).smooth);
}
Moment table_moment(Moment moment) {
    return smooth_color_table(moment).moment;
}
const ColorTable* table_of_family(std::string_view family, Moment moment) {
    if (family == color_families[0]) return &smooth_color_table(moment);
    if (family == color_families[1]) return &default_color_table(moment);
    return nullptr;
}

}  // namespace stormcellar::render
