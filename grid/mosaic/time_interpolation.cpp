#include "grid/mosaic/time_interpolation.h"

#include <algorithm>
#include <cmath>

#include "base/name_list.h"
#include "base/parallel.h"
#include "grid/mosaic/instant_brick.h"

namespace stormcellar::grid {
namespace {

static_assert(is_in_order(time_method_facts, &TimeMethodFacts::method));

Status check(const TimedView& view, const ColumnGeometry& geometry,
             const Quantization& quantization) {
    if (*view.view.spec != geometry.spec()) {
        return fail(ErrorCode::bad_argument,
                    "the grid and the geometry of its columns have different specs");
    }
    if (view.view.quantization != quantization) {
        return fail(ErrorCode::bad_argument, "the two grids have steps of different sizes");
    }
    return {};
}

}  // namespace

std::string_view time_method_name(TimeMethod method) {
    return time_method_facts[static_cast<std::size_t>(method)].name;
}

std::optional<TimeMethod> time_method_from_name(std::string_view name) {
    return key_named(time_method_facts, &TimeMethodFacts::method, name);
}

Result<BrickGrid> grid_at(const TimedView& before, const std::optional<TimedView>& after,
                          const ColumnGeometry& geometry, const InstantOptions& options) {
    const BrickView& view = before.view;
    if (Status good = check(before, geometry, view.quantization); !good) return pass_on(good);
    if (after) {
        if (Status good = check(*after, geometry, view.quantization); !good) return pass_on(good);
    }
    const InstantMaker maker(before, after, geometry, options);
    BrickGrid made(geometry.spec(), view.quantization);
    std::vector<BricksWriter> writers;
    writers.reserve(static_cast<std::size_t>(view.bricks_x));
    for (int bx = 0; bx < view.bricks_x; ++bx)
        writers.emplace_back(made);
    for_each_piece(view.bricks_x, options.threads, [&](int bx) {
        for (int by = 0; by < view.bricks_y; ++by) {
            InstantBrick brick(maker, bx, by);
            for (int bz = 0; bz < view.bricks_z; ++bz)
                brick.write(bz, writers[static_cast<std::size_t>(bx)]);
        }
    });
    made.finish(writers);
    return made;
}

}  // namespace stormcellar::grid
