#include "stormcellar/grid/method.h"

#include "base/name_list.h"

namespace stormcellar::grid {
namespace {

static_assert(is_in_order(interpolation_facts, &InterpolationFacts::interpolation));

constexpr std::string_view area_prefix = "area, ";

}  // namespace

CellExtent cell_extent_of(std::string_view method_name) {
    return method_name.starts_with(area_prefix) ? CellExtent::area : CellExtent::point;
}

std::string_view interpolation_name(Interpolation interpolation) {
    return facts_of(interpolation).name;
}

std::string Method::name() const {
    std::string text{cell == CellExtent::area ? area_prefix : ""};
    if (facts_of(interpolation).takes_one_gate) text += "column-";
    text += interpolation_name(interpolation);
    return text;
}

}  // namespace stormcellar::grid
