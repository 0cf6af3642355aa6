#include "stormcellar/grid/method.h"

#include <array>
#include <utility>

namespace stormcellar::grid {
namespace {

constexpr std::array<std::pair<Interpolation, std::string_view>, 4> names = {{
    {Interpolation::nearest, "nearest"},
    {Interpolation::linear, "linear"},
    {Interpolation::eight_point, "eight-point"},
    {Interpolation::beam_weighted, "beam-weighted"},
}};

constexpr std::string_view area_prefix = "area, ";

}  // namespace

CellExtent cell_extent_of(std::string_view method_name) {
    return method_name.starts_with(area_prefix) ? CellExtent::area : CellExtent::point;
}

std::string_view interpolation_name(Interpolation interpolation) {
    for (const auto& [known, name] : names) {
        if (known == interpolation) return name;
    }
    return "unknown";
}

std::optional<Interpolation> interpolation_from_name(std::string_view name) {
    for (const auto& [interpolation, known] : names) {
        if (known == name) return interpolation;
    }
    return std::nullopt;
}

std::string Method::name() const {
    const bool by_column =
        interpolation == Interpolation::nearest || interpolation == Interpolation::linear;
    std::string text{cell == CellExtent::area ? area_prefix : ""};
    if (by_column) text += "column-";
    text += interpolation_name(interpolation);
    return text;
}

}  // namespace stormcellar::grid
