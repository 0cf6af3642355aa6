#include "grid/mosaic/extrapolation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "grid/cells/code_block.h"
#include "grid/cells/nearest_code.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

constexpr double longest_step_s = 300;
constexpr float limit_without_echo_dbz = 0;
constexpr std::size_t columns_in_brick = static_cast<std::size_t>(brick_edge) * brick_edge;

// Returns the place from which echo moves to column (x, y).
ColumnPoint traced_back(ColumnPoint to, const MotionField& motion, double seconds) {
    const int steps = std::max(1, static_cast<int>(std::ceil(seconds / longest_step_s)));
    const double step_s = seconds / steps;
    ColumnPoint at = to;
    for (int step = 0; step < steps; ++step) {
        // Take the motion in the middle of the step, so that echo follows a curve.
        const CellMotion first = motion.at(at.x, at.y);
        const CellMotion middle = motion.at(at.x - static_cast<double>(first.x) * step_s / 2,
                                            at.y - static_cast<double>(first.y) * step_s / 2);
        at.x -= static_cast<double>(middle.x) * step_s;
        at.y -= static_cast<double>(middle.y) * step_s;
    }
    return at;
}

float median_of(std::vector<float>& values) {
    const std::size_t half = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

// Returns the median over the fields of the motion that `motion_of` takes from each field.
template <class MotionOf>
CellMotion median_over(std::span<const MotionField> fields, const MotionOf& motion_of) {
    std::vector<float> x, y;
    for (const MotionField& field : fields) {
        const CellMotion motion = motion_of(field);
        x.push_back(motion.x);
        y.push_back(motion.y);
    }
    return {median_of(x), median_of(y)};
}

// Makes the bricks of one stack of a later grid.
class LaterBricks {
  public:
    LaterBricks(const BrickView& latest, const MotionField& motion, double seconds, int bx, int by)
        : view_(latest), bx_(bx), by_(by) {
        const int x0 = bx * brick_edge, y0 = by * brick_edge;
        const BrickExtent extent = brick_extent(*latest.spec, bx, by, 0);
        double west = x0, east = x0, south = y0, north = y0;
        for (int x = 0; x < extent.x; ++x) {
            for (int y = 0; y < extent.y; ++y) {
                const ColumnPoint from = traced_back(
                    {static_cast<double>(x0 + x), static_cast<double>(y0 + y)}, motion, seconds);
                const bool is_first = x == 0 && y == 0;
                west = is_first ? from.x : std::min(west, from.x);
                east = is_first ? from.x : std::max(east, from.x);
                south = is_first ? from.y : std::min(south, from.y);
                north = is_first ? from.y : std::max(north, from.y);
                from_[static_cast<std::size_t>(x * brick_edge + y)] = from;
            }
        }
        box_ = {static_cast<int>(std::floor(west)), static_cast<int>(std::floor(south)),
                static_cast<int>(std::floor(east)) + 1, static_cast<int>(std::floor(north)) + 1};
    }

    // Writes the brick at height `bz` (counted in bricks).
    void write(int bz, BricksWriter& writer) {
        const std::size_t index = view_.brick_index(bx_, by_, bz);
        if (const auto status = CodeBlock::uniform_status(view_, box_, bz)) {
            writer.put_uniform(index, *status);
            return;
        }
        source_.read(view_, box_, bz);
        const BrickExtent extent = brick_extent(*view_.spec, bx_, by_, bz);
        std::array<std::uint16_t, brick_cells> codes{};
        for (int x = 0; x < extent.x; ++x) {
            for (int y = 0; y < extent.y; ++y) {
                const auto column = static_cast<std::size_t>(x * brick_edge + y);
                mix_column(from_[column], extent.z, codes.data() + column * brick_edge);
            }
        }
        if (view_.quantization.code_bytes == 2) {
            writer.put_codes(index, codes.data(), extent);
            return;
        }
        std::array<std::uint8_t, brick_cells> bytes{};
        std::ranges::transform(codes, bytes.begin(),
                               [](std::uint16_t code) { return static_cast<std::uint8_t>(code); });
        writer.put_codes(index, bytes.data(), extent);
    }

  private:
    void mix_column(ColumnPoint from, int height, std::uint16_t* codes) const {
        const int x0 = static_cast<int>(std::floor(from.x));
        const int y0 = static_cast<int>(std::floor(from.y));
        const auto fx = static_cast<float>(from.x - x0), fy = static_cast<float>(from.y - y0);
        const std::array<float, 4> weights = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy,
                                              fx * fy};
        const std::array<const std::uint16_t*, 4> corners = {
            source_.column(x0, y0), source_.column(x0 + 1, y0), source_.column(x0, y0 + 1),
            source_.column(x0 + 1, y0 + 1)};
        for (int z = 0; z < height; ++z) {
            codes[z] =
                mixed_code({corners[0][z], corners[1][z], corners[2][z], corners[3][z]}, weights);
        }
    }

    [[nodiscard]] std::uint16_t mixed_code(const std::array<std::uint16_t, 4>& codes,
                                           const std::array<float, 4>& weights) const {
        if (codes[0] == codes[1] && codes[0] == codes[2] && codes[0] == codes[3]) return codes[0];
        const Quantization& quantization = view_.quantization;
        float limit = limit_without_echo_dbz;
        for (const std::uint16_t code : codes) {
            if (quantization.status_of(code) == CellStatus::value)
                limit = std::min(limit, quantization.value_of(code));
        }
        constexpr Blending blending = Blending::with_detection_limit;
        Mixture mixture;
        for (std::size_t corner = 0; corner < codes.size(); ++corner) {
            const CellStatus status = quantization.status_of(codes[corner]);
            const float value =
                status == CellStatus::value ? quantization.value_of(codes[corner]) : 0;
            mixture.add_as<false>({status, value, limit, 0}, weights[corner], blending);
        }
        const CellResult mixed = mixture.result_as<false>(blending);
        if (mixed.status == CellStatus::ambiguous) return first_value_code;
        if (mixed.status != CellStatus::value) return static_cast<std::uint16_t>(mixed.status);
        // The mean is within the range of the four values and the limit, but the limit may be below
        // the range of codes.
        const double code = nearest_code(mixed.value, quantization);
        return static_cast<std::uint16_t>(
            std::clamp(code, static_cast<double>(quantization.first_code()),
                       static_cast<double>(quantization.largest_code())));
    }

    const BrickView& view_;
    int bx_, by_;
    std::array<ColumnPoint, columns_in_brick> from_{};
    ColumnBox box_;
    CodeBlock source_;
};

}  // namespace

MotionField median_motion(std::span<const MotionField> fields, const GridSpec& spec) {
    const int width = bricks_along(spec.nx) + 1, height = bricks_along(spec.ny) + 1;
    std::vector<CellMotion> nodes;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            nodes.push_back(median_over(fields, [&](const MotionField& field) {
                return field.at(column * brick_edge, row * brick_edge);
            }));
        }
    }
    const CellMotion whole =
        median_over(fields, [](const MotionField& field) { return field.whole(); });
    return {width, height, brick_edge, std::move(nodes), whole};
}

Result<BrickGrid> extrapolate(const BrickView& latest, const MotionField& motion, double seconds,
                              int threads) {
    if (!std::isfinite(seconds) || seconds < 0) {
        return fail(ErrorCode::bad_argument, "echo cannot be moved by {} s", seconds);
    }
    BrickGrid made(*latest.spec, latest.quantization);
    std::vector<BricksWriter> writers;
    writers.reserve(static_cast<std::size_t>(latest.bricks_x));
    for (int bx = 0; bx < latest.bricks_x; ++bx)
        writers.emplace_back(made);
    for_each_piece(latest.bricks_x, threads, [&](int bx) {
        for (int by = 0; by < latest.bricks_y; ++by) {
            LaterBricks bricks(latest, motion, seconds, bx, by);
            for (int bz = 0; bz < latest.bricks_z; ++bz)
                bricks.write(bz, writers[static_cast<std::size_t>(bx)]);
        }
    });
    made.finish(writers);
    return made;
}

}  // namespace stormcellar::grid
