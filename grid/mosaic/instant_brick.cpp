#include "grid/mosaic/instant_brick.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/cells/nearest_code.h"
#include "grid/sweep/sweep_stack.h"

namespace stormcellar::grid {
namespace {

std::size_t column_in_brick(int x, int y) {
    const int column = x * brick_edge + y;
    return static_cast<std::size_t>(column);
}

std::size_t cell_in_brick(int x, int y, int z) {
    const int cell = (x * brick_edge + y) * brick_edge + z;
    return static_cast<std::size_t>(cell);
}

// Returns the nearest code. Clamps a value beyond the range of codes to the end of the range.
std::uint16_t clamped_code(float value, const Quantization& quantization) {
    const double code = nearest_code(value, quantization);
    return static_cast<std::uint16_t>(std::clamp(code,
                                                 static_cast<double>(quantization.first_code()),
                                                 static_cast<double>(quantization.largest_code())));
}

// Returns the status of a cell if neither end has a value: the status that both have, or the status
// of the only end that sees the cell. Returns none if the two ends see different statuses.
std::optional<CellStatus> joined(CellStatus a, CellStatus b) {
    if (a == b || b == CellStatus::not_seen) return a;
    if (a == CellStatus::not_seen) return b;
    return std::nullopt;
}

}  // namespace

InstantMaker::End InstantMaker::end_of(const TimedView& timed, const ColumnGeometry& geometry,
                                       const InstantOptions& options) {
    End end{timed, seconds_between(options.instant, timed.middle), std::nullopt};
    if (options.sweep_times) {
        const SitePosition& site = geometry.site();
        end.clock =
            SweepClock::of_volume(timed.sweeps, BeamGeometry(site.latitude_deg, site.altitude_m),
                                  options.instant, timed.middle);
    }
    return end;
}

InstantMaker::InstantMaker(const TimedView& before, const std::optional<TimedView>& after,
                           const ColumnGeometry& geometry, const InstantOptions& options)
    : geometry_(&geometry),
      options_(options),
      blending_(blending_of(options.moment)),
      has_classes_(level2::facts_of(options.moment).is_categorical),
      moves_(options.method == TimeMethod::advected && options.motion != nullptr) {
    if (is_tdwr(geometry.site().icao)) limit_.at_1km_dbz = tdwr_limit_at_1km_dbz;
    ends_.push_back(end_of(before, geometry, options));
    if (after) ends_.push_back(end_of(*after, geometry, options));
    if (options.method == TimeMethod::nearest && ends_.size() == 2) {
        const bool later = std::abs(ends_[1].middle_s) < std::abs(ends_[0].middle_s);
        ends_.erase(later ? ends_.begin() : ends_.begin() + 1);
    }
}

InstantBrick::InstantBrick(const InstantMaker& maker, int bx, int by)
    : maker_(maker), bx_(bx), by_(by) {
    const GridSpec& spec = maker.geometry_->spec();
    for (int y = 0; y < brick_edge && by * brick_edge + y < spec.ny; ++y) {
        const auto row = maker.geometry_->row(by * brick_edge + y);
        for (int x = 0; x < brick_edge && bx * brick_edge + x < spec.nx; ++x) {
            const std::size_t column = column_in_brick(x, y);
            const int ix = bx * brick_edge + x;
            arc_m_[column] = row[static_cast<std::size_t>(ix)].arc_m;
            if (maker.moves_) {
                motion_[column] = maker.options_.motion->at(ix, by * brick_edge + y);
            }
        }
    }
    for (std::size_t end = 0; end < maker.ends_.size(); ++end)
        read_times(end);
}

// Computes the time of each cell of one end, for the columns of the brick and all heights.
void InstantBrick::read_times(std::size_t end) {
    const InstantMaker::End& from = maker_.ends_[end];
    if (!from.clock) return;
    const GridSpec& spec = maker_.geometry_->spec();
    const std::size_t height = spec.levels_m.size();
    std::vector<float>& seconds = sources_[end].column_seconds;
    seconds.assign(columns * height, static_cast<float>(from.middle_s));
    for (int y = 0; y < brick_edge && by_ * brick_edge + y < spec.ny; ++y) {
        const auto row = maker_.geometry_->row(by_ * brick_edge + y);
        for (int x = 0; x < brick_edge && bx_ * brick_edge + x < spec.nx; ++x) {
            const int ix = bx_ * brick_edge + x;
            const ColumnPlace& place = row[static_cast<std::size_t>(ix)];
            const std::size_t column = column_in_brick(x, y);
            from.clock->read(static_cast<double>(place.azimuth_deg),
                             static_cast<double>(place.arc_m), spec.levels_m,
                             std::span(seconds).subspan(column * height, height));
        }
    }
}

// Copies the times of the cells of the brick at height `bz`.
void InstantBrick::take_times(std::size_t end, int bz) {
    Source& source = sources_[end];
    source.seconds.fill(static_cast<float>(maker_.ends_[end].middle_s));
    if (source.column_seconds.empty()) return;
    const std::size_t height = maker_.geometry_->spec().levels_m.size();
    const auto first = static_cast<std::size_t>(bz) * brick_edge;
    const std::size_t count = std::min<std::size_t>(brick_edge, height - first);
    for (std::size_t column = 0; column < columns; ++column) {
        std::copy_n(source.column_seconds.data() + column * height + first, count,
                    source.seconds.data() + column * brick_edge);
    }
}

// Finds the columns that the cells of the brick may come from.
void InstantBrick::find_box(std::size_t end) {
    const GridSpec& spec = maker_.geometry_->spec();
    Source& source = sources_[end];
    const int x0 = bx_ * brick_edge, y0 = by_ * brick_edge;
    const int x1 = std::min(x0 + brick_edge, spec.nx) - 1;
    const int y1 = std::min(y0 + brick_edge, spec.ny) - 1;
    source.box = {x0, y0, x1, y1};
    source.is_still = !maker_.moves_;
    if (source.is_still) return;
    float west = static_cast<float>(x1), east = static_cast<float>(x0);
    float south = static_cast<float>(y1), north = static_cast<float>(y0);
    // A column moves by its motion times the seconds of a cell, at all heights. So it moves
    // farthest, either way, at the earliest and the latest time of the brick's cells.
    const auto [early, late] = std::minmax_element(source.seconds.begin(), source.seconds.end());
    for (const float seconds : {*early, *late}) {
        for (int x = x0; x <= x1; ++x) {
            for (int y = y0; y <= y1; ++y) {
                const CellMotion& motion =
                    motion_[static_cast<std::size_t>((x - x0) * brick_edge + y - y0)];
                const float from_x = static_cast<float>(x) + motion.x * seconds;
                const float from_y = static_cast<float>(y) + motion.y * seconds;
                west = std::min(west, from_x);
                east = std::max(east, from_x);
                south = std::min(south, from_y);
                north = std::max(north, from_y);
            }
        }
    }
    // If echo would come from a wider box than this, use one time for the whole volume. Without
    // this limit, a frame could take minutes.
    constexpr float most_columns = 256;
    const bool is_too_wide = east - west > most_columns || north - south > most_columns;
    if (is_too_wide && *early != *late) {
        source.seconds.fill(static_cast<float>(maker_.ends_[end].middle_s));
        return find_box(end);
    }
    source.box = {static_cast<int>(std::floor(west)) - 1, static_cast<int>(std::floor(south)) - 1,
                  static_cast<int>(std::floor(east)) + 2, static_cast<int>(std::floor(north)) + 2};
}

Sample InstantBrick::sample_of(std::uint16_t code) const {
    const Quantization& quantization = maker_.ends_[0].timed.view.quantization;
    const CellStatus status = quantization.status_of(code);
    if (status != CellStatus::value) return {status, 0, 0, 0};
    return {CellStatus::value, quantization.value_of(code), 0, 0};
}

// Adds the detection limit to a sample without echo, so that it can be mixed with echo.
Sample InstantBrick::with_limit(Sample sample, std::size_t cell) {
    const bool counts =
        sample.status == CellStatus::no_echo && maker_.blending_ == Blending::with_detection_limit;
    if (!counts) return sample;
    float& limit = limits_[cell];
    if (std::isnan(limit)) {
        const std::size_t level = static_cast<std::size_t>(bz_) * brick_edge + cell % brick_edge;
        const double height_m = maker_.geometry_->spec().levels_m[level];
        const auto arc_m = static_cast<double>(arc_m_[cell / brick_edge]);
        limit = static_cast<float>(maker_.limit_.at(std::hypot(arc_m, height_m)));
    }
    sample.limit = limit;
    return sample;
}

// Mixes the four columns around a place.
Sample InstantBrick::mix(const Source& source, double x, double y, std::size_t cell) {
    const std::size_t z = cell % brick_edge;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const auto code = [&](int ix, int iy) { return source.codes.column(ix, iy)[z]; };
    // For values that wrap and for classes, only the nearest column counts.
    if (is_circular(maker_.blending_) || maker_.has_classes_) {
        return sample_of(code(x0 + (fx >= 0.5F ? 1 : 0), y0 + (fy >= 0.5F ? 1 : 0)));
    }
    const std::array<std::uint16_t, 4> codes = {code(x0, y0), code(x0 + 1, y0), code(x0, y0 + 1),
                                                code(x0 + 1, y0 + 1)};
    const std::uint16_t first = codes[0];
    if (first == codes[1] && first == codes[2] && first == codes[3]) return sample_of(first);
    const std::array<float, 4> weights = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy,
                                          fx * fy};
    Mixture mixture;
    for (std::size_t corner = 0; corner < codes.size(); ++corner) {
        mixture.add_as<false>(with_limit(sample_of(codes[corner]), cell), weights[corner],
                              maker_.blending_);
    }
    const CellResult mixed = mixture.result_as<false>(maker_.blending_);
    return {mixed.status, mixed.value, 0, 0};
}

// Returns the sample of one end for a cell: the cell itself, or the place from which its echo moved
// to the cell.
Sample InstantBrick::sample(std::size_t end, std::size_t cell) {
    const Source& source = sources_[end];
    const std::size_t column = cell / brick_edge;
    const int ix = bx_ * brick_edge + static_cast<int>(column) / brick_edge;
    const int iy = by_ * brick_edge + static_cast<int>(column) % brick_edge;
    if (source.is_still) return sample_of(source.codes.column(ix, iy)[cell % brick_edge]);
    const float seconds = source.seconds[cell];
    const double x = ix + static_cast<double>(motion_[column].x * seconds);
    const double y = iy + static_cast<double>(motion_[column].y * seconds);
    return mix(source, x, y, cell);
}

// Returns the weight that the later end has at the instant. The weight is linear between the times
// of the two ends, which are counted from the instant.
float InstantBrick::weight_of_after(std::size_t cell) const {
    const float before = sources_[0].seconds[cell], after = sources_[1].seconds[cell];
    if (!(after > before)) return 0.5F;
    return std::clamp(-before / (after - before), 0.0F, 1.0F);
}

std::uint16_t InstantBrick::code_of(const CellResult& cell) const {
    if (cell.status == CellStatus::ambiguous) return first_value_code;
    if (cell.status != CellStatus::value) return static_cast<std::uint16_t>(cell.status);
    return clamped_code(cell.value, maker_.ends_[0].timed.view.quantization);
}

void InstantBrick::write(int bz, BricksWriter& writer) {
    const BrickView& shape = maker_.ends_[0].timed.view;
    const std::size_t index = shape.brick_index(bx_, by_, bz);
    if (const auto status = make(bz)) {
        writer.put_uniform(index, *status);
        return;
    }
    const BrickExtent extent = brick_extent(maker_.geometry_->spec(), bx_, by_, bz);
    if (shape.quantization.code_bytes == 2) {
        writer.put_codes(index, codes_.data(), extent);
        return;
    }
    std::array<std::uint8_t, brick_cells> bytes{};
    std::transform(codes_.begin(), codes_.end(), bytes.begin(),
                   [](std::uint16_t code) { return static_cast<std::uint8_t>(code); });
    writer.put_codes(index, bytes.data(), extent);
}

// Makes the codes of the brick at height `bz`. If the cells that may contribute have a single state
// at each end, returns the state of the brick without reading a cell.
std::optional<CellStatus> InstantBrick::make(int bz) {
    bz_ = bz;
    const std::size_t ends = maker_.ends_.size();
    std::optional<CellStatus> uniform;
    for (std::size_t end = 0; end < ends; ++end) {
        take_times(end, bz);
        find_box(end);
        const auto status =
            CodeBlock::uniform_status(maker_.ends_[end].timed.view, sources_[end].box, bz);
        if (end == 0) {
            uniform = status;
        } else {
            uniform = uniform && status ? joined(*uniform, *status) : std::nullopt;
        }
    }
    if (uniform) return uniform;
    for (std::size_t end = 0; end < ends; ++end)
        sources_[end].codes.read(maker_.ends_[end].timed.view, sources_[end].box, bz);
    fill();
    return std::nullopt;
}

// Mixes the two ends cell by cell. Does not mix if both ends have the same state, or if one end has
// not seen the cell.
void InstantBrick::fill() {
    codes_.fill(0);
    limits_.fill(std::numeric_limits<float>::quiet_NaN());
    const bool alone = maker_.ends_.size() == 1;
    const BrickExtent extent = brick_extent(maker_.geometry_->spec(), bx_, by_, bz_);
    for (int x = 0; x < extent.x; ++x) {
        for (int y = 0; y < extent.y; ++y) {
            for (int z = 0; z < extent.z; ++z) {
                const std::size_t cell = cell_in_brick(x, y, z);
                const Sample a = sample(0, cell);
                const Sample b = alone ? Sample{} : sample(1, cell);
                const bool alike = a.status == b.status && a.status != CellStatus::value;
                if (alike || b.status == CellStatus::not_seen) {
                    codes_[cell] = code_of({a.status, a.value});
                } else if (a.status == CellStatus::not_seen) {
                    codes_[cell] = code_of({b.status, b.value});
                } else if (maker_.has_classes_) {
                    const Sample& nearer = weight_of_after(cell) > 0.5F ? b : a;
                    codes_[cell] = code_of({nearer.status, nearer.value});
                } else {
                    codes_[cell] = code_of(blend(with_limit(a, cell), with_limit(b, cell),
                                                 weight_of_after(cell), maker_.blending_));
                }
            }
        }
    }
}

}  // namespace stormcellar::grid
