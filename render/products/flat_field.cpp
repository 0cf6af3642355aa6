#include "render/products/flat_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

#include "base/parallel.h"
#include "render/products/cell_mixer.h"
#include "render/products/hail_field.h"
#include "render/products/sweep_field.h"
#include "stormcellar/render/view_geometry.h"
#include "stormcellar/retrieve/vertical_liquid.h"

namespace stormcellar::render {
namespace {

using grid::brick_edge;
using grid::BrickView;
using grid::CellStatus;

// Calls work(cells of the column, place in the field) for every column.
template <class Work>
FlatField for_each_column(const BrickView& view, int threads, const Work& work) {
    FlatField field(view.spec->nx, view.spec->ny);
    for_each_piece(view.bricks_y, threads, [&](int by) {
        ColumnCells cells;
        for (int bx = 0; bx < view.bricks_x; ++bx) {
            bool must_read = true;
            const bool all_same = is_uniform_stack(view, bx, by);
            for (int iy = by * brick_edge; iy < std::min(field.height, (by + 1) * brick_edge);
                 ++iy) {
                for (int ix = bx * brick_edge; ix < std::min(field.width, (bx + 1) * brick_edge);
                     ++ix) {
                    if (must_read) read_column(view, ix, iy, cells);
                    must_read = !all_same;
                    work(cells, field, field.index(ix, iy));
                }
            }
        }
    });
    return field;
}

// Returns the state of a column for which the product has no value.
CellStatus state_without_value(const ColumnCells& cells) {
    bool seen = false;
    for (const CellStatus status : cells.status) {
        if (status == CellStatus::range_folded || status == CellStatus::ambiguous) return status;
        seen = seen || status != CellStatus::not_seen;
    }
    return seen ? CellStatus::no_echo : CellStatus::not_seen;
}

struct EchoTop {
    double height_m = 0;
    bool at_least = false;
};

// Computes the top from the highest cell that reaches the threshold.
EchoTop top_above(const ColumnCells& cells, const std::vector<double>& levels_m, std::size_t cell,
                  double threshold_dbz) {
    const std::size_t above = cell + 1;
    if (above == levels_m.size()) return {levels_m[cell], true};
    switch (cells.status[above]) {
        case CellStatus::no_echo:
            return {levels_m[cell], false};
        case CellStatus::value: {
            const auto here = static_cast<double>(cells.values[cell]);
            const auto there = static_cast<double>(cells.values[above]);
            return {
                std::lerp(levels_m[cell], levels_m[above], (here - threshold_dbz) / (here - there)),
                false};
        }
        default:
            return {levels_m[cell], true};
    }
}

bool reaches(const ColumnCells& cells, std::size_t cell, double threshold_dbz) {
    return cells.status[cell] == CellStatus::value &&
           static_cast<double>(cells.values[cell]) >= threshold_dbz;
}

// Returns the echo top, or none if no cell reaches the threshold.
std::optional<EchoTop> echo_top(const ColumnCells& cells, const std::vector<double>& levels_m,
                                double threshold_dbz) {
    for (std::size_t i = levels_m.size(); i-- > 0;) {
        if (reaches(cells, i, threshold_dbz)) return top_above(cells, levels_m, i, threshold_dbz);
    }
    return std::nullopt;
}

// Returns the heights of a grid's columns for VIL.
retrieve::LiquidColumn liquid_column(const grid::GridSpec& spec, std::optional<double> radar_m) {
    const HeightRange range = height_range(spec);
    return {spec.levels_m, range.bottom_m, range.top_m, radar_m};
}

}  // namespace

FlatField::FlatField(int columns, int rows)
    : width(columns),
      height(rows),
      values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)),
      status(values.size(), CellStatus::not_seen) {}

void read_column(const BrickView& view, int ix, int iy, ColumnCells& cells) {
    const int nz = view.spec->nz();
    cells.status.resize(static_cast<std::size_t>(nz));
    cells.values.assign(static_cast<std::size_t>(nz), 0);
    const auto width = static_cast<std::size_t>(view.quantization.code_bytes);
    for (int first = 0; first < nz; first += brick_edge) {
        const std::size_t brick =
            view.brick_index(ix / brick_edge, iy / brick_edge, first / brick_edge);
        const grid::BrickEntry& entry = view.bricks[brick];
        const int count = std::min(brick_edge, nz - first);
        const auto at = static_cast<std::size_t>(first);
        if (entry.kind == grid::BrickKind::uniform) {
            std::fill_n(cells.status.begin() + first, count, entry.uniform_status);
            continue;
        }
        if (entry.kind == grid::BrickKind::status_only) {
            std::uint32_t states = states_of_run(
                view, entry,
                static_cast<std::size_t>((ix % brick_edge) * brick_edge + iy % brick_edge) *
                    brick_edge);
            for (std::size_t z = 0; z < static_cast<std::size_t>(count); ++z, states >>= 2)
                cells.status[at + z] = static_cast<CellStatus>(states & 3U);
            continue;
        }
        const std::size_t offset = view.offset_x(ix) + view.offset_y(iy) + view.offset_z(first);
        const std::byte* codes = view.codes.data() + offset * width;
        for (std::size_t z = 0; z < static_cast<std::size_t>(count); ++z) {
            std::uint16_t code = 0;
            if (width == 1) {
                code = std::to_integer<std::uint16_t>(codes[z]);
            } else {
                std::memcpy(&code, codes + 2 * z, sizeof code);
            }
            cells.status[at + z] = view.quantization.status_of(code);
            if (cells.status[at + z] == CellStatus::value)
                cells.values[at + z] = view.quantization.value_of(code);
        }
    }
}

FlatField composite_field(const BrickView& view, const std::vector<ColumnSummary>& columns) {
    FlatField field(view.spec->nx, view.spec->ny);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const CellStatus status = columns[i].status();
        const bool valued = status == CellStatus::value;
        field.put(i, status, valued ? view.quantization.value_of(columns[i].max_code) : 0);
    }
    return field;
}

Result<FlatField> cappi_field(const BrickView& view, level2::Moment moment, double height_m,
                              int threads) {
    const auto levels = levels_about(*view.spec, height_m);
    if (!levels) return pass_on(levels);
    FlatField field(view.spec->nx, view.spec->ny);
    const float half_period = grid::half_period_of(moment, 0);
    for_each_piece(field.height, threads, [&](int iy) {
        CellMixer mixer(moment);
        for (int ix = 0; ix < field.width; ++ix) {
            const grid::Sample lower = cell_of(view, half_period, ix, iy, levels->lower);
            const grid::Sample upper = cell_of(view, half_period, ix, iy, levels->upper);
            // Most columns are clear at both levels, or were not seen at either level.
            if (lower.status == upper.status && lower.status != CellStatus::value) {
                field.put(field.index(ix, iy), lower.status, 0);
                continue;
            }
            mixer.clear();
            mixer.add(lower, 1 - levels->upper_share);
            mixer.add(upper, levels->upper_share);
            const grid::CellResult cell = mixer.result();
            field.put(field.index(ix, iy), cell.status, cell.value);
        }
    });
    return field;
}

FlatField echo_top_field(const BrickView& view, double threshold_dbz, int threads) {
    std::vector<std::uint8_t> at_least(view.spec->column_count());
    FlatField field = for_each_column(
        view, threads, [&](const ColumnCells& cells, FlatField& out, std::size_t place) {
            const auto top = echo_top(cells, view.spec->levels_m, threshold_dbz);
            if (!top) return out.put(place, state_without_value(cells), 0);
            out.put(place, CellStatus::value, static_cast<float>(top->height_m / 1000));
            at_least[place] = top->at_least ? 1 : 0;
        });
    field.at_least = std::move(at_least);
    return field;
}

FlatField vil_field(const BrickView& view, std::optional<double> radar_m, int threads) {
    const retrieve::LiquidColumn column = liquid_column(*view.spec, radar_m);
    return for_each_column(
        view, threads, [&](const ColumnCells& cells, FlatField& out, std::size_t place) {
            const bool valued = std::find(cells.status.begin(), cells.status.end(),
                                          CellStatus::value) != cells.status.end();
            if (!valued) {
                out.put(place, state_without_value(cells), 0);
                return;
            }
            const double vil =
                retrieve::vertical_liquid_kg_per_m2(column, cells.values, cells.status);
            out.put(place, CellStatus::value, static_cast<float>(vil));
        });
}

FlatField vil_density_field(const BrickView& view, double threshold_dbz, double radar_m,
                            int threads) {
    const retrieve::LiquidColumn column = liquid_column(*view.spec, radar_m);
    const auto& levels_m = view.spec->levels_m;
    return for_each_column(
        view, threads, [&](const ColumnCells& cells, FlatField& out, std::size_t place) {
            const auto top = echo_top(cells, levels_m, threshold_dbz);
            if (!top) return out.put(place, state_without_value(cells), 0);
            const double depth_m = std::max(top->height_m - radar_m, least_depth_m);
            const double g_per_m2 =
                1000 * retrieve::vertical_liquid_kg_per_m2(column, cells.values, cells.status);
            out.put(place, CellStatus::value, static_cast<float>(g_per_m2 / depth_m));
        });
}

FlatField maximum_height_field(const BrickView& view, double threshold_dbz, int threads) {
    return for_each_column(view, threads,
                           [&](const ColumnCells& cells, FlatField& out, std::size_t place) {
                               std::optional<std::size_t> best;
                               for (std::size_t i = 0; i < cells.status.size(); ++i) {
                                   if (!reaches(cells, i, threshold_dbz)) continue;
                                   if (!best || cells.values[i] > cells.values[*best]) best = i;
                               }
                               if (!best) return out.put(place, state_without_value(cells), 0);
                               out.put(place, CellStatus::value,
                                       static_cast<float>(view.spec->levels_m[*best] / 1000));
                           });
}

Result<FlatField> layer_maximum_field(const BrickView& view, const HeightLayer& layer,
                                      double radar_m, int threads) {
    const auto& levels_m = view.spec->levels_m;
    const auto first = std::ranges::lower_bound(levels_m, radar_m + layer.bottom_m);
    const auto last = std::ranges::lower_bound(levels_m, radar_m + layer.top_m);
    if (first == last)
        return fail(ErrorCode::bad_argument,
                    "the grid has no level from {:.0f} to {:.0f} m above the radar, which is at "
                    "{:.0f} m above sea level",
                    layer.bottom_m, layer.top_m, radar_m);
    const auto from = first - levels_m.begin(), to = last - levels_m.begin();
    return for_each_column(
        view, threads, [&](const ColumnCells& cells, FlatField& out, std::size_t place) {
            const ColumnCells inside{{cells.status.begin() + from, cells.status.begin() + to},
                                     {cells.values.begin() + from, cells.values.begin() + to}};
            std::optional<float> largest;
            for (std::size_t i = 0; i < inside.status.size(); ++i)
                if (inside.status[i] == CellStatus::value)
                    largest = std::max(inside.values[i], largest.value_or(inside.values[i]));
            if (!largest) return out.put(place, state_without_value(inside), 0);
            out.put(place, CellStatus::value, *largest);
        });
}

namespace {

// Returns the height of the lowest radar, above which a mosaic has its layers of rotation.
double lowest_radar_m(const FrameFacts& facts) {
    if (facts.sites.empty()) return 0;
    return std::ranges::min_element(facts.sites, {}, &grid::SitePosition::altitude_m)->altitude_m;
}

}  // namespace

double radar_height_m(const FrameFacts& facts) {
    return retrieve::mean_radar_height_m(facts.sites).value_or(0);
}

FlatField rain_total_field(const BrickView& view, int threads) {
    return for_each_column(view, threads,
                           [](const ColumnCells& cells, FlatField& out, std::size_t place) {
                               out.put(place, cells.status.front(), cells.values.front());
                           });
}

FlatField lowest_seen_field(const BrickView& view, int threads) {
    return for_each_column(view, threads,
                           [&](const ColumnCells& cells, FlatField& out, std::size_t place) {
                               for (std::size_t i = 0; i < cells.status.size(); ++i) {
                                   if (cells.status[i] == CellStatus::not_seen) continue;
                                   out.put(place, CellStatus::value,
                                           static_cast<float>(view.spec->levels_m[i] / 1000));
                                   return;
                               }
                           });
}

FlatField highest_seen_field(const BrickView& view, int threads) {
    return for_each_column(view, threads,
                           [&](const ColumnCells& cells, FlatField& out, std::size_t place) {
                               for (std::size_t i = cells.status.size(); i-- > 0;) {
                                   if (cells.status[i] == CellStatus::not_seen) continue;
                                   out.put(place, CellStatus::value,
                                           static_cast<float>(view.spec->levels_m[i] / 1000));
                                   return;
                               }
                           });
}

Result<FlatField> map_field(const BrickView& view, const FrameFacts& facts, const Scene& scene,
                            const std::vector<ColumnSummary>& columns, int threads) {
    switch (scene.product) {
        case Product::composite:
            return composite_field(view, columns);
        case Product::ppi:
            return sweep_in_columns(*view.sweep, *view.spec, threads);
        case Product::cappi:
            return cappi_field(view, scene.moment, scene.cappi_height_m, threads);
        case Product::echo_top:
            return echo_top_field(view, scene.echo_top_dbz, threads);
        case Product::vil:
            return vil_field(view, retrieve::mean_radar_height_m(facts.sites), threads);
        case Product::vil_density:
            return vil_density_field(view, scene.echo_top_dbz, radar_height_m(facts), threads);
        case Product::maximum_height:
            return maximum_height_field(view, scene.echo_top_dbz, threads);
        case Product::lowest_seen:
            return lowest_seen_field(view, threads);
        case Product::highest_seen:
            return highest_seen_field(view, threads);
        case Product::rotation:
        case Product::rotation_aloft:
        case Product::rotation_tracks:
            return layer_maximum_field(view, *facts_of(scene.product).layer, lowest_radar_m(facts),
                                       threads);
        case Product::mesh:
        case Product::posh:
        case Product::shi:
            return hail_field(view, facts_of(scene.product).hail, scene.freezing_levels,
                              radar_height_m(facts), columns, threads);
        case Product::rain_total:
            return rain_total_field(view, threads);
        case Product::volume:
        case Product::section:
            break;
    }
    return fail(ErrorCode::internal, "{} is not a map", product_name(scene.product));
}

}  // namespace stormcellar::render
