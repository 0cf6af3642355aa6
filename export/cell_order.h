// export/cell_order.h -- copies cells of a grid into the order of files: x fastest, then y, then z;
// internal.
//
// Threads   Pure function.
// Errors    None. The box must be within the grid.
#pragma once

#include <cstddef>

#include "stormcellar/grid/grid_spec.h"

namespace stormcellar {

// A range of cells along each axis, and the sides of the array that takes them.
struct CellBox {
    int first_x = 0, end_x = 0;
    int first_y = 0, end_y = 0;
    int first_z = 0, end_z = 0;
    std::size_t row = 0;   // cells from a row to the next
    std::size_t rows = 0;  // rows from a level to the next
};

// Calls from(index of the cell) for each cell of the box. Copies row by row, so that reads and
// writes both stay within the processor's cache.
template <class Cell, class From>
void copy_in_file_order(const grid::GridSpec& spec, const CellBox& box, const From& from,
                        Cell* first) {
    for (int iy = box.first_y; iy < box.end_y; ++iy) {
        for (int iz = box.first_z; iz < box.end_z; ++iz) {
            Cell* to = first + (static_cast<std::size_t>(iz - box.first_z) * box.rows +
                                static_cast<std::size_t>(iy - box.first_y)) *
                                   box.row;
            std::size_t at = spec.index(box.first_x, iy, iz);
            for (int ix = box.first_x; ix < box.end_x; ++ix, at += spec.levels_m.size())
                *to++ = from(at);
        }
    }
}

}  // namespace stormcellar
