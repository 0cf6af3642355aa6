// tests/grid/method_of.h -- makes a method of gridding from the members that most tests vary.
#pragma once

#include "stormcellar/grid/method.h"

namespace stormcellar::grid {

[[nodiscard]] inline Method method_of(Interpolation interpolation,
                                      CellExtent cell = CellExtent::point,
                                      Averaging averaging = Averaging::in_db) {
    return Method{.interpolation = interpolation, .cell = cell, .averaging = averaging};
}

}  // namespace stormcellar::grid
