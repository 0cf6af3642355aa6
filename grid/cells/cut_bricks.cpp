#include "grid/cells/cut_bricks.h"

namespace stormcellar::grid {

BrickGrid cut_bricks(const BrickView& view, const GridWindow& window) {
    BrickGrid cut(window_spec(*view.spec, window), view.quantization);
    const BrickView shape = cut.view();
    BricksWriter writer(cut);
    const int first_x = window.first_x / brick_edge;
    const int first_y = window.first_y / brick_edge;
    for (int bx = 0; bx < shape.bricks_x; ++bx) {
        for (int by = 0; by < shape.bricks_y; ++by) {
            for (int bz = 0; bz < shape.bricks_z; ++bz) {
                writer.copy(shape.brick_index(bx, by, bz), view,
                            view.brick_index(first_x + bx, first_y + by, bz));
            }
        }
    }
    cut.finish(std::span(&writer, 1));
    return cut;
}

}  // namespace stormcellar::grid
