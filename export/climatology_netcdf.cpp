#include "export/climatology_netcdf.h"

#include <array>
#include <functional>
#include <vector>

#include <netcdf.h>

#include "export/grid_coordinates.h"
#include "export/netcdf_builder.h"
#include "stormcellar/base/version.h"

namespace stormcellar::netcdf {
namespace {

using grid::ColumnTally;

constexpr float fill = NC_FILL_FLOAT;
constexpr int deflate_level = 1;
// The thresholds are the edges of bins from 0 dBZ on.
constexpr std::size_t first_threshold_bin = 7;
constexpr std::size_t thresholds = ColumnTally::bins - first_threshold_bin;

// Writes the variables of a climatology, each over all groups and columns.
class ClimatologyFile {
  public:
    ClimatologyFile(std::span<const TallyGroup> groups, const ClimatologyText& text)
        : groups_(groups), spec_(groups.front().tally.spec()), text_(text) {
        const MapNames names = map_names(spec_);
        group_ = file_.dimension(text.group, groups.size());
        threshold_ = file_.dimension("threshold", thresholds);
        level_ = file_.dimension("z", spec_.levels_m.size());
        map_ = {file_.dimension(names.y, static_cast<std::size_t>(spec_.ny)),
                file_.dimension(names.x, static_cast<std::size_t>(spec_.nx))};
    }

    Result<std::vector<std::byte>> write() {
        write_globals();
        write_axes();
        write_counts();
        write_values();
        write_layers("frequency", threshold_, thresholds,
                     "share of the frames that saw the column in which its greatest reflectivity "
                     "reached the threshold",
                     [](const ColumnTally& tally, std::size_t column, std::size_t at) {
                         return tally.from_bin_on(column, first_threshold_bin + at);
                     });
        write_layers("echo_top_frequency", level_, spec_.levels_m.size(),
                     "share of the frames that saw the column in which its echo top (18.5 dBZ) was "
                     "at or above the height",
                     [](const ColumnTally& tally, std::size_t column, std::size_t at) {
                         return tally.tops_from(column, at);
                     });
        return file_.finish();
    }

  private:
    using Statistic = double (*)(const ColumnTally& tally, std::size_t column);
    using Count = std::uint32_t (*)(const ColumnTally& tally, std::size_t column, std::size_t at);

    void write_globals() {
        file_.text(NetcdfBuilder::file, "Conventions", "CF-1.8");
        file_.text(NetcdfBuilder::file, "title", "Statistics of radar reflectivity");
        file_.text(NetcdfBuilder::file, "source", text_.source);
        file_.text(NetcdfBuilder::file, "history",
                   fmt::format("made by stormcellar {}", software_version));
        file_.text(NetcdfBuilder::file, "time_coverage_start", text_.time_coverage_start);
        file_.text(NetcdfBuilder::file, "time_coverage_end", text_.time_coverage_end);
        file_.text(
            NetcdfBuilder::file, "comment",
            "Statistics are of the greatest reflectivity of each column, over the frames in "
            "which the column was seen. Quantiles and means are of the frames with a value.");
    }

    void write_axes() {
        std::vector<int> numbers;
        for (const TallyGroup& group : groups_)
            numbers.push_back(group.number);
        const int group = file_.variable(text_.group, NC_INT, {group_});
        file_.text(group, "long_name", fmt::format("{} (UTC)", text_.group));
        const int threshold = file_.variable("threshold", NC_DOUBLE, {threshold_});
        file_.text(threshold, "long_name", "threshold of reflectivity");
        file_.text(threshold, "units", "dBZ");
        const int level = file_.variable("z", NC_DOUBLE, {level_});
        write_attributes(file_, level, height_attributes());
        write_mapping(file_, spec_);
        std::vector<double> edges;
        for (std::size_t i = 0; i < thresholds; ++i)
            edges.push_back(ColumnTally::edge_dbz(first_threshold_bin + i));
        file_.write(group, std::span<const int>(numbers));
        file_.write(threshold, std::span<const double>(edges));
        file_.write(level, std::span(spec_.levels_m));
        write_map_axes(file_, spec_, map_);
        write_positions(file_, spec_, map_, deflate_level);
    }

    // Counts of frames: all, and for each column those that saw it and those that did not.
    void write_counts() {
        std::vector<int> frames, missing, seen, not_seen;
        for (const TallyGroup& group : groups_) {
            const auto count = static_cast<int>(group.tally.grids());
            frames.push_back(count);
            missing.push_back(static_cast<int>(group.instants) - count);
            for (std::size_t column = 0; column < spec_.column_count(); ++column) {
                seen.push_back(static_cast<int>(group.tally.seen(column)));
                not_seen.push_back(count - seen.back());
            }
        }
        write_count("frames", {group_}, "frames that were counted", frames);
        write_count("missing_frames", {group_},
                    "instants without a frame, because no radar sent volumes around them", missing);
        write_count("seen", {group_, map_.y, map_.x},
                    "frames in which some cell of the column was seen", seen);
        write_count("not_seen", {group_, map_.y, map_.x},
                    "frames in which no cell of the column was seen", not_seen);
    }

    void write_count(const char* name, const std::vector<int>& dimensions, const char* long_name,
                     const std::vector<int>& counts) {
        const int variable = file_.variable(name, NC_INT, dimensions);
        file_.text(variable, "long_name", long_name);
        file_.text(variable, "units", "1");
        if (dimensions.size() > 1) {
            file_.deflate(variable, deflate_level);
            refer_to_map(file_, variable, spec_);
        }
        file_.write(variable, std::span<const int>(counts));
    }

    void write_values() {
        write_value("maximum", "greatest reflectivity",
                    [](const ColumnTally& t, std::size_t c) { return t.greatest_dbz(c); });
        write_value("mean_dbz", "mean of the reflectivity in dBZ",
                    [](const ColumnTally& t, std::size_t c) { return t.mean_dbz(c); });
        write_value("mean_z", "mean of the reflectivity factor Z, shown in dBZ",
                    [](const ColumnTally& t, std::size_t c) { return t.mean_z_as_dbz(c); });
        write_value("median", "median of the reflectivity, to 2.5 dBZ",
                    [](const ColumnTally& t, std::size_t c) { return t.quantile_dbz(c, 0.5); });
        write_value("quantile_90", "quantile of 90 % of the reflectivity, to 2.5 dBZ",
                    [](const ColumnTally& t, std::size_t c) { return t.quantile_dbz(c, 0.9); });
        write_value("quantile_99", "quantile of 99 % of the reflectivity, to 2.5 dBZ",
                    [](const ColumnTally& t, std::size_t c) { return t.quantile_dbz(c, 0.99); });
    }

    void write_value(const char* name, const char* long_name, Statistic statistic) {
        std::vector<float> values;
        for (const TallyGroup& group : groups_) {
            for (std::size_t column = 0; column < spec_.column_count(); ++column) {
                values.push_back(group.tally.with_value(column) == 0
                                     ? fill
                                     : static_cast<float>(statistic(group.tally, column)));
            }
        }
        write_field(name, {group_, map_.y, map_.x}, long_name, "dBZ", values);
    }

    void write_layers(const char* name, int dimension, std::size_t layers, const char* long_name,
                      Count count) {
        std::vector<float> shares;
        for (const TallyGroup& group : groups_) {
            for (std::size_t at = 0; at < layers; ++at) {
                for (std::size_t column = 0; column < spec_.column_count(); ++column) {
                    const auto seen = static_cast<float>(group.tally.seen(column));
                    const auto hits = static_cast<float>(count(group.tally, column, at));
                    shares.push_back(seen == 0 ? fill : hits / seen);
                }
            }
        }
        write_field(name, {group_, dimension, map_.y, map_.x}, long_name, "1", shares);
    }

    void write_field(const char* name, const std::vector<int>& dimensions, const char* long_name,
                     const char* units, const std::vector<float>& values) {
        const int variable = file_.variable(name, NC_FLOAT, dimensions);
        file_.deflate(variable, deflate_level);
        file_.fill_value(variable, fill);
        file_.text(variable, "long_name", long_name);
        file_.text(variable, "units", units);
        file_.text(variable, "ancillary_variables", "seen not_seen");
        refer_to_map(file_, variable, spec_);
        file_.write(variable, std::span<const float>(values));
    }

    NetcdfBuilder file_;
    std::span<const TallyGroup> groups_;
    const grid::GridSpec& spec_;
    const ClimatologyText& text_;
    int group_ = 0, threshold_ = 0, level_ = 0;
    MapDimensions map_;
};

}  // namespace

Status write_climatology(FileSystem& file_system, const std::filesystem::path& path,
                         std::span<const TallyGroup> groups, const ClimatologyText& text) {
    if (groups.empty()) return fail(ErrorCode::bad_argument, "{}: nothing to write", path.native());
    for (const TallyGroup& group : groups) {
        if (group.tally.spec() == groups.front().tally.spec()) continue;
        return fail(ErrorCode::bad_argument, "{}: the groups have different grids", path.native());
    }
    const std::scoped_lock lock(library_mutex());
    const auto bytes = ClimatologyFile(groups, text).write();
    if (!bytes) return pass_on(bytes);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
