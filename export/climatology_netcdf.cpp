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

using grid::GridTally;
using grid::ValueTally;

constexpr float fill = NC_FILL_FLOAT;
constexpr int deflate_level = 1;
// The thresholds are the edges of bins. The first threshold is 0 dBZ, the edge of this bin.
constexpr std::size_t first_threshold_bin = 7;
constexpr std::size_t thresholds = ValueTally::bins - first_threshold_bin;

// The places whose values were counted: columns (counted by their greatest value) or cells.
struct Places {
    const char* prefix;  // of the names of the variables
    const char* place;   // word for a place, in texts
    const char* value;   // word for a value, in texts
    const ValueTally& (*of)(const GridTally& tally);
    std::size_t layers;  // number of levels; 1 for columns
};

// Writes the variables of a climatology. Each variable covers all groups and all places.
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
        write_frame_counts();
        const auto of_columns = [](const GridTally& tally) -> const ValueTally& {
            return tally.columns();
        };
        write_places({"", "column", "greatest reflectivity of the column", of_columns, 1});
        write_echo_tops();
        if (groups_.front().tally.cells()) {
            const auto of_cells = [](const GridTally& tally) -> const ValueTally& {
                return *tally.cells();
            };
            write_places(
                {"cell_", "cell", "reflectivity of the cell", of_cells, spec_.levels_m.size()});
        }
        return file_.finish();
    }

  private:
    using Statistic = double (*)(const ValueTally& tally, std::size_t place);

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
            "Statistics are of the greatest reflectivity of each column, and those named cell_ of "
            "the cells, over the frames in which the column or cell was seen. Quantiles and means "
            "are of the frames with a value.");
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
            edges.push_back(ValueTally::edge_dbz(first_threshold_bin + i));
        file_.write(group, std::span<const int>(numbers));
        file_.write(threshold, std::span<const double>(edges));
        file_.write(level, std::span(spec_.levels_m));
        write_map_axes(file_, spec_, map_);
        write_positions(file_, spec_, map_, deflate_level);
    }

    void write_frame_counts() {
        std::vector<int> frames, missing;
        for (const TallyGroup& group : groups_) {
            frames.push_back(static_cast<int>(group.tally.grids()));
            missing.push_back(static_cast<int>(group.instants) - frames.back());
        }
        write_count("frames", {group_}, "frames that were counted", frames);
        write_count("missing_frames", {group_},
                    "instants without a frame, because no radar sent volumes around them", missing);
    }

    void write_places(const Places& places) {
        write_seen(places);
        write_frequency(places);
        const auto write = [&](const char* name, const char* text, Statistic statistic) {
            write_value(places, name, fmt::format(fmt::runtime(text), places.value), statistic);
        };
        write("maximum", "greatest {}",
              [](const ValueTally& t, std::size_t at) { return t.greatest_dbz(at); });
        write("mean_dbz", "mean of the {} in dBZ",
              [](const ValueTally& t, std::size_t at) { return t.mean_dbz(at); });
        write("mean_z", "mean of the {} as the factor Z, shown in dBZ",
              [](const ValueTally& t, std::size_t at) { return t.mean_z_as_dbz(at); });
        write("median", "median of the {}, to 2.5 dBZ",
              [](const ValueTally& t, std::size_t at) { return t.quantile_dbz(at, 0.5); });
        write("quantile_90", "quantile of 90 % of the {}, to 2.5 dBZ",
              [](const ValueTally& t, std::size_t at) { return t.quantile_dbz(at, 0.9); });
        write("quantile_99", "quantile of 99 % of the {}, to 2.5 dBZ",
              [](const ValueTally& t, std::size_t at) { return t.quantile_dbz(at, 0.99); });
    }

    [[nodiscard]] std::vector<int> dimensions_of(const Places& places) const {
        if (places.layers == 1) return {group_, map_.y, map_.x};
        return {group_, level_, map_.y, map_.x};
    }

    // Calls `work` with each group's tally and each place's number, in the order of the variables'
    // elements.
    template <class Work>
    void for_each_place(const Places& places, Work work) const {
        for (const TallyGroup& group : groups_) {
            for (std::size_t layer = 0; layer < places.layers; ++layer) {
                for (std::size_t column = 0; column < spec_.column_count(); ++column)
                    work(group, places.of(group.tally), column * places.layers + layer);
            }
        }
    }

    void write_seen(const Places& places) {
        std::vector<int> seen, not_seen;
        for_each_place(places,
                       [&](const TallyGroup& group, const ValueTally& tally, std::size_t place) {
                           seen.push_back(static_cast<int>(tally.seen(place)));
                           not_seen.push_back(static_cast<int>(group.tally.grids()) - seen.back());
                       });
        const auto write = [&](const char* name, const char* text, const std::vector<int>& counts) {
            write_count((places.prefix + std::string{name}).c_str(), dimensions_of(places),
                        fmt::format(fmt::runtime(text), places.place).c_str(), counts);
        };
        write("seen", "frames in which some part of the {} was seen", seen);
        write("not_seen", "frames in which no part of the {} was seen", not_seen);
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

    void write_value(const Places& places, const char* name, const std::string& long_name,
                     Statistic statistic) {
        std::vector<float> values;
        for_each_place(places, [&](const TallyGroup&, const ValueTally& tally, std::size_t place) {
            values.push_back(
                tally.with_value(place) == 0 ? fill : static_cast<float>(statistic(tally, place)));
        });
        write_field(places, name, dimensions_of(places), long_name, "dBZ", values);
    }

    [[nodiscard]] static float share_of(std::uint32_t hits, std::uint32_t seen) {
        return seen == 0 ? fill : static_cast<float>(hits) / static_cast<float>(seen);
    }

    // Writes the frequencies. The dimension of thresholds follows that of groups, so each group is
    // one block.
    void write_frequency(const Places& places) {
        std::vector<float> shares;
        for (const TallyGroup& group : groups_) {
            const ValueTally& tally = places.of(group.tally);
            for (std::size_t bin = first_threshold_bin; bin < ValueTally::bins; ++bin) {
                for (std::size_t layer = 0; layer < places.layers; ++layer) {
                    for (std::size_t column = 0; column < spec_.column_count(); ++column) {
                        const std::size_t place = column * places.layers + layer;
                        shares.push_back(
                            share_of(tally.from_bin_on(place, bin), tally.seen(place)));
                    }
                }
            }
        }
        std::vector<int> dimensions = dimensions_of(places);
        dimensions.insert(dimensions.begin() + 1, threshold_);
        write_field(places, "frequency", dimensions,
                    fmt::format("share of the frames that saw the {} in which the {} reached the "
                                "threshold",
                                places.place, places.value),
                    "1", shares);
    }

    void write_echo_tops() {
        std::vector<float> shares;
        for (const TallyGroup& group : groups_) {
            for (std::size_t level = 0; level < spec_.levels_m.size(); ++level) {
                for (std::size_t column = 0; column < spec_.column_count(); ++column) {
                    shares.push_back(share_of(group.tally.tops_from(column, level),
                                              group.tally.columns().seen(column)));
                }
            }
        }
        write_field({"", "column", "", nullptr, 1}, "echo_top_frequency",
                    {group_, level_, map_.y, map_.x},
                    "share of the frames that saw the column in which its echo top (18.5 dBZ) was "
                    "at or above the height",
                    "1", shares);
    }

    void write_field(const Places& places, const char* name, const std::vector<int>& dimensions,
                     const std::string& long_name, const char* units,
                     const std::vector<float>& values) {
        const std::string full = places.prefix + std::string{name};
        const int variable = file_.variable(full.c_str(), NC_FLOAT, dimensions);
        file_.deflate(variable, deflate_level);
        file_.fill_value(variable, fill);
        file_.text(variable, "long_name", long_name);
        file_.text(variable, "units", units);
        file_.text(variable, "ancillary_variables",
                   fmt::format("{0}seen {0}not_seen", places.prefix));
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
    const MutexLock lock(library_mutex());
    const auto bytes = ClimatologyFile(groups, text).write();
    if (!bytes) return pass_on(bytes);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
