// Calls the functions of the C interface in any order, with any arguments.
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

#include "stormcellar/catalog/catalog.h"
#include "tests/fuzz/call_script.h"
#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {
namespace {

namespace fs = std::filesystem;
using level2::wire::Bytes;

// A small volume and a small grid in memory, and a catalog and a cache on disk.
class Files {
  public:
    Files() {
        const auto seeds = container_seeds();
        volume_ = seeds.front().bytes;
        directory_ =
            fs::temp_directory_path() / ("stormcellar-calls-" + std::to_string(::getpid()));
        const fs::path day = directory_ / "cache/KBGM/REF/20050822";
        fs::create_directories(day);
        grid_ = day / "KBGM_REF_20050822_024414_123.scg";
        const Bytes grid = grid_file_seeds().front().bytes;
        std::ofstream(grid_, std::ios::binary)
            .write(reinterpret_cast<const char*>(grid.data()),
                   static_cast<std::streamsize>(grid.size()));
        auto catalog = catalog::CatalogWriter::open(directory_ / "catalog");
        catalog::FileFacts facts;
        facts.path = "/drop/KBGM";
        facts.station = "KBGM";
        facts.state = catalog::FileState::complete;
        facts.volumes.emplace_back().start_time = parse_utc("2005-08-22T02:44:14Z", {}).value();
        require(catalog && catalog->register_file(facts), "the catalog cannot be made");
    }
    Files(const Files&) = delete;
    Files& operator=(const Files&) = delete;
    ~Files() {
        std::error_code ignored;
        fs::remove_all(directory_, ignored);
    }
    [[nodiscard]] const Bytes& volume() const { return volume_; }
    // Returns a path of a directory or a file; most do not fit the call.
    [[nodiscard]] std::string path(Script& script) const {
        return script.pick(std::array<fs::path, 6>{directory_ / "cache", directory_ / "catalog",
                                                   grid_, directory_ / "none", "/", ""});
    }

  private:
    Bytes volume_;
    fs::path directory_, grid_;
};

const char* moment_of(Script& script) {
    return script.pick(std::array<const char*, 4>{nullptr, "REF", "RHO", "REF"},
                       std::array<const char*, 5>{"VEL", "VELD POW", "REF RHO", "XYZ", ""});
}

void open_volume(Script& script, Objects& objects, const Files& files) {
    stormcellar_read_options options{};
    script.set_size(options);
    options.threads = script.pick(std::array{0, 1, 2}, std::array{-1});
    options.volume = script.number();
    options.moments = moment_of(script);
    options.station = script.pick(std::array<const char*, 4>{nullptr, "KTLX", "", "elsewhere"});
    const auto bytes =
        script.below(4) == 3 ? script.rest() : std::span<const std::byte>(files.volume());
    stormcellar_volume* made = nullptr;
    CallError error(script);
    const bool is_good = error.check(
        stormcellar_volume_from_bytes(bytes.data(), bytes.size(), &options, &made, error.get()));
    keep(objects.volumes, made, is_good, script);
}

void open_path(Script& script, Objects& objects, const Files& files) {
    const std::string path = files.path(script);
    stormcellar_volume* made = nullptr;
    CallError error(script);
    const bool is_good =
        error.check(stormcellar_volume_open(path.c_str(), nullptr, &made, error.get()));
    keep(objects.volumes, made, is_good, script);
}

// Requires that arrays of gates have the promised size, by reading all of them.
void read_gates(Script& script, const stormcellar_volume* volume, std::int32_t sweep,
                std::int32_t moment, std::size_t radials, const stormcellar_moment_facts& facts) {
    const std::size_t count =
        radials * static_cast<std::size_t>(facts.gates) + (script.below(24) == 23 ? 1 : 0);
    std::vector<float> values(count);
    std::vector<std::uint8_t> states(count);
    const void* codes = nullptr;
    CallError error(script);
    const bool is_good = error.check(stormcellar_moment_values(volume, sweep, moment, values.data(),
                                                               values.size(), error.get()));
    error.check(stormcellar_moment_states(volume, sweep, moment, states.data(), states.size(),
                                          error.get()));
    error.check(stormcellar_moment_codes(volume, sweep, moment, &codes, error.get()));
    if (!is_good || facts.gates == 0) return;
    const std::vector<std::uint8_t> copied(
        static_cast<const std::uint8_t*>(codes),
        static_cast<const std::uint8_t*>(codes) + count * static_cast<unsigned>(facts.code_bytes));
    for (std::size_t i = 0; i < count; ++i)
        require((states[i] == STORMCELLAR_GATE_VALUE) == (values[i] == values[i]),
                "a value without the state of one");
}

void read_volume(Script& script, Objects& objects, const Files& /*files*/) {
    const stormcellar_volume* const volume = script.any(objects.volumes);
    (void)described<stormcellar_volume_facts>(script, [&](auto* facts, auto* error) {
        return stormcellar_volume_describe(volume, facts, error);
    });
    const std::int32_t sweep = script.number(), moment = script.number();
    const auto facts = described<stormcellar_sweep_facts>(script, [&](auto* to, auto* error) {
        return stormcellar_sweep_describe(volume, sweep, to, error);
    });
    std::vector<stormcellar_radial> radials(static_cast<std::size_t>(facts.radials));
    CallError error(script);
    error.check(
        stormcellar_sweep_radials(volume, sweep, radials.data(), radials.size(), error.get()));
    std::array<char, 12> text{};
    error.check(stormcellar_volume_problem(volume, script.number(), text.data(),
                                           script.below(text.size() + 1), error.get()));
    std::int32_t found = 0;
    error.check(stormcellar_moment_find(volume, sweep, moment_of(script), &found, error.get()));
    const auto gates = described<stormcellar_moment_facts>(script, [&](auto* to, auto* failed) {
        return stormcellar_moment_describe(volume, sweep, moment, to, failed);
    });
    read_gates(script, volume, sweep, moment, radials.size(), gates);
}

void derive(Script& script, Objects& objects, const Files& /*files*/) {
    stormcellar_derive_options options{};
    script.set_size(options);
    options.dealias = script.pick(std::array<const char*, 3>{nullptr, "off", "region"},
                                  std::array<const char*, 1>{"no"});
    options.storm_motion = script.pick(std::array<const char*, 3>{nullptr, "240/15", "mean"},
                                       std::array<const char*, 1>{"?"});
    options.quality = script.pick(std::array{0.0, 0.5}, std::array{2.0, std::nan("")});
    const char* const wanted = script.pick(std::array<const char*, 3>{"POW", nullptr, "REF"},
                                           std::array<const char*, 3>{"VELD SRV", "KDP RATE", "?"});
    stormcellar_volume* made = nullptr;
    CallError error(script);
    const bool is_good = error.check(stormcellar_volume_derive(script.any(objects.volumes), wanted,
                                                               &options, &made, error.get()));
    keep(objects.volumes, made, is_good, script);
}

// Returns the options of a small grid, or options that no grid can have. `levels` must outlive the
// options.
stormcellar_grid_options small_grid(Script& script, std::array<double, 3>& levels) {
    constexpr int most = std::numeric_limits<int>::max();
    stormcellar_grid_options options{};
    options.size = sizeof options;
    options.moment = moment_of(script);
    options.columns = script.pick(std::array{12, 17, 1, 33}, std::array{-1, most});
    options.rows = script.pick(std::array{12, 9, 1, 40}, std::array{-1, most});
    options.spacing_m =
        script.pick(std::array{1000.0, 5000.0, 0.0}, std::array{-1.0, std::nan("")});
    levels = {500, script.pick(std::array{1500.0, 9000.0}, std::array{400.0, std::nan("")}),
              20'000};
    options.levels_m = script.below(24) == 23 ? nullptr : levels.data();
    options.level_count = script.pick(std::array{1, 2, 3}, std::array{-1});
    options.has_center = static_cast<std::int32_t>(script.below(2));
    options.center_latitude_deg =
        script.pick(std::array{42.2, 35.3}, std::array{90.0, std::nan("")});
    options.center_longitude_deg = script.pick(std::array{-76.0, -97.3}, std::array{180.0, 1e300});
    options.interpolation = script.pick(
        std::array<const char*, 5>{nullptr, "nearest", "linear", "eight-point", "beam-weighted"},
        std::array<const char*, 1>{"cubic"});
    options.mean_of_cell = static_cast<std::int32_t>(script.below(2));
    options.average_in_z = static_cast<std::int32_t>(script.below(2));
    options.threads = script.pick(std::array{0, 1, 2}, std::array{-1});
    return options;
}

void make_grid(Script& script, Objects& objects, const Files& /*files*/) {
    std::array<double, 3> levels{};
    const auto options = small_grid(script, levels);
    stormcellar_grid* made = nullptr;
    CallError error(script);
    const bool is_good = error.check(
        stormcellar_grid_make(script.any(objects.volumes), &options, &made, error.get()));
    keep(objects.grids, made, is_good, script);
}

stormcellar_mosaic_options mosaic_options(Script& script) {
    stormcellar_mosaic_options options{};
    script.set_size(options);
    options.overlap = script.pick(std::array<const char*, 4>{nullptr, "mean", "maximum", "nearest"},
                                  std::array<const char*, 1>{"median"});
    options.length_m = script.pick(std::array{0.0, 250'000.0}, std::array{-1.0, std::nan("")});
    return options;
}

void make_mosaic(Script& script, Objects& objects, const Files& /*files*/) {
    std::array<double, 3> levels{};
    const auto options = small_grid(script, levels);
    const auto rule = mosaic_options(script);
    const std::array<const stormcellar_volume*, 2> volumes{script.any(objects.volumes),
                                                           script.any(objects.volumes)};
    stormcellar_grid* made = nullptr;
    CallError error(script);
    const bool is_good = error.check(stormcellar_mosaic_make(volumes.data(), 1 + script.below(2),
                                                             &options, &rule, &made, error.get()));
    keep(objects.grids, made, is_good, script);
}

void merge_grids(Script& script, Objects& objects, const Files& /*files*/) {
    const auto rule = mosaic_options(script);
    const std::array<const stormcellar_grid*, 2> grids{script.any(objects.grids),
                                                       script.any(objects.grids)};
    stormcellar_grid* made = nullptr;
    CallError error(script);
    const bool is_good = error.check(
        stormcellar_grid_merge(grids.data(), script.below(3), &rule, &made, error.get()));
    keep(objects.grids, made, is_good, script);
}

void read_grid(Script& script, Objects& objects, const Files& /*files*/) {
    const stormcellar_grid* const grid = script.any(objects.grids);
    const auto facts = described<stormcellar_grid_facts>(
        script, [&](auto* to, auto* error) { return stormcellar_grid_describe(grid, to, error); });
    const double* levels = nullptr;
    const float* values = nullptr;
    const std::uint8_t* states = nullptr;
    CallError error(script);
    error.check(stormcellar_grid_levels(grid, &levels, error.get()));
    error.check(stormcellar_grid_values(grid, &values, error.get()));
    error.check(stormcellar_grid_states(grid, &states, error.get()));
    const std::size_t count = static_cast<std::size_t>(facts.columns) *
                              static_cast<std::size_t>(facts.rows) *
                              static_cast<std::size_t>(facts.levels);
    for (std::size_t i = 0; i < count; ++i)
        require(states[i] <= STORMCELLAR_CELL_AMBIGUOUS && values[i] == values[i],
                "a cell has an unknown state or no number");
    for (std::int32_t i = 1; i < facts.levels; ++i)
        require(levels[i] > levels[i - 1], "the levels do not rise");
}

void draw(Script& script, Objects& objects, const Files& /*files*/) {
    constexpr std::array<const char*, 6> texts{"theme=light", "no-labels", "tilt=30",
                                               "sweep=1",     "=",         "overlay=cells"};
    const std::array<const char*, 2> settings{"no-labels", script.pick(texts)};
    stormcellar_draw_options options{};
    options.size = sizeof options;
    options.product =
        script.pick(std::array<const char*, 4>{"ppi", "composite", "cappi", "lowest-seen"},
                    std::array<const char*, 4>{"section", "rain-total", "radar", ""});
    options.moment = moment_of(script);
    options.width =
        script.pick(std::array{40, 33, 41}, std::array{-1, std::numeric_limits<int>::max()});
    options.height = 30;
    options.settings = settings.data();
    options.setting_count = script.pick(std::array{1}, std::array{2});
    options.format = script.pick(std::array{0, 1}, std::array{2});
    options.threads = script.pick(std::array{0, 1, 2}, std::array{-1});
    stormcellar_picture* made = nullptr;
    CallError error(script);
    const bool is_good = error.check(
        script.below(2) == 0
            ? stormcellar_grid_draw(script.any(objects.grids), &options, &made, error.get())
            : stormcellar_volume_draw(script.any(objects.volumes), &options, &made, error.get()));
    keep(objects.pictures, made, is_good, script);
}

void read_picture(Script& script, Objects& objects, const Files& /*files*/) {
    const stormcellar_picture* const picture = script.any(objects.pictures);
    const auto facts = described<stormcellar_picture_facts>(script, [&](auto* to, auto* error) {
        return stormcellar_picture_describe(picture, to, error);
    });
    const std::uint8_t* bytes = nullptr;
    CallError error(script);
    if (!error.check(stormcellar_picture_bytes(picture, &bytes, error.get()))) return;
    if (facts.bytes > 0) (void)std::vector<std::uint8_t>(bytes, bytes + facts.bytes);
}

void measure(Script& script, Objects& objects, const Files& /*files*/) {
    std::array<double, 3> levels{};
    const auto options = small_grid(script, levels);
    stormcellar_ladder_options how{};
    script.set_size(how);
    how.columns = script.pick(std::array{5, 20}, std::array{-1});
    how.rounds = script.pick(std::array{1}, std::array{-1});
    if (how.size < sizeof how) return;  // the default takes long
    stormcellar_ladder* made = nullptr;
    std::size_t count = 0;
    CallError error(script);
    const bool is_good = error.check(stormcellar_ladder_measure(
        script.any(objects.volumes), &options, &how, &made, &count, error.get()));
    keep(objects.ladders, made, is_good, script);
    const stormcellar_ladder* const ladder = script.any(objects.ladders);
    (void)described<stormcellar_rung>(script, [&](auto* to, auto* failed) {
        return stormcellar_ladder_describe(ladder, script.below(30), to, failed);
    });
}

stormcellar_query query_of(Script& script) {
    constexpr std::array<std::int64_t, 6> times{0,
                                                1'124'678'654'123,
                                                1'124'678'654'000,
                                                -1,
                                                std::numeric_limits<std::int64_t>::max(),
                                                std::numeric_limits<std::int64_t>::min()};
    stormcellar_query query{};
    script.set_size(query);
    query.name = script.pick(std::array<const char*, 5>{nullptr, "KBGM", "KTLX", "../..", ""});
    query.moment = moment_of(script);
    query.from_ms = script.pick(times);
    query.to_ms = script.pick(times);
    return query;
}

void query_catalog(Script& script, Objects& objects, const Files& files) {
    const std::string path = files.path(script);
    stormcellar_catalog* made = nullptr;
    CallError error(script);
    bool is_good = error.check(stormcellar_catalog_open(path.c_str(), &made, error.get()));
    keep(objects.catalogs, made, is_good, script);
    const auto query = query_of(script);
    stormcellar_file_list* list = nullptr;
    std::size_t count = 0;
    is_good = error.check(
        stormcellar_catalog_list(script.any(objects.catalogs), &query, &list, &count, error.get()));
    keep(objects.files, list, is_good, script);
    const stormcellar_file_list* const listed = script.any(objects.files);
    const auto facts = described<stormcellar_file_facts>(script, [&](auto* to, auto* failed) {
        return stormcellar_file_list_describe(listed, script.below(3), to, failed);
    });
    if (facts.path != nullptr)
        require(std::string(facts.path) == "/drop/KBGM", "the catalog has another path");
}

void query_cache(Script& script, Objects& objects, const Files& files) {
    const std::string path = files.path(script);
    stormcellar_cache* made = nullptr;
    CallError error(script);
    bool is_good = error.check(stormcellar_cache_open(path.c_str(), &made, error.get()));
    keep(objects.caches, made, is_good, script);
    const auto query = query_of(script);
    stormcellar_grid_list* list = nullptr;
    std::size_t count = 0;
    is_good = error.check(
        stormcellar_cache_list(script.any(objects.caches), &query, &list, &count, error.get()));
    keep(objects.lists, list, is_good, script);
    const stormcellar_grid_list* const listed = script.any(objects.lists);
    const auto facts = described<stormcellar_grid_file_facts>(script, [&](auto* to, auto* failed) {
        return stormcellar_grid_list_describe(listed, script.below(3), to, failed);
    });
    stormcellar_grid* grid = nullptr;
    is_good = error.check(stormcellar_grid_read(facts.path, &grid, error.get()));
    keep(objects.grids, grid, is_good, script);
}

void read_file(Script& script, Objects& objects, const Files& files) {
    const std::string path = files.path(script);
    stormcellar_grid* grid = nullptr;
    CallError error(script);
    const bool is_good = error.check(stormcellar_grid_read(path.c_str(), &grid, error.get()));
    keep(objects.grids, grid, is_good, script);
}

// Frees an object. Objects that were made from it stay.
void free_one(Script& script, Objects& objects, const Files& /*files*/) {
    if (script.below(2) == 0 && !objects.volumes.empty()) objects.volumes.pop_back();
    if (script.below(2) == 0 && !objects.grids.empty()) objects.grids.pop_back();
    if (script.below(4) == 0) objects.caches.clear();
    if (script.below(4) == 0) objects.catalogs.clear();
}

constexpr std::array calls{open_volume, open_volume, open_path,    read_volume, derive,
                           make_grid,   make_grid,   make_mosaic,  merge_grids, read_grid,
                           draw,        draw,        read_picture, measure,     query_catalog,
                           query_cache, read_file,   free_one};

}  // namespace

void check_calls(std::span<const std::byte> input) {
    static const Files files;
    constexpr int most_calls = 60;
    Script script(input);
    Objects objects;
    for (int i = 0; i < most_calls && !script.has_ended(); ++i)
        calls[script.below(calls.size())](script, objects, files);
}

}  // namespace stormcellar::fuzz
