#include "cli/loop/files_loop.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/ranges.h>

#include "base/checksum.h"
#include "cli/picture/picture.h"
#include "cli/shared/commands.h"
#include "cli/shared/input_files.h"
#include "cli/shared/progress.h"
#include "pipeline/care/archive_plan.h"
#include "pipeline/care/rebuild_catalog.h"
#include "pipeline/drop/archive_volumes.h"
#include "pipeline/keep/instance_lock.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/base/station_rule.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

// Number of tries to get the lock, because a process that was just killed may hold the lock a
// moment longer.
constexpr int lock_tries = 20;
constexpr auto lock_pause = std::chrono::milliseconds{50};
constexpr std::size_t most_rejected_named = 20;
// Times before and after every volume.
constexpr UtcTime earliest{std::chrono::days{1}}, latest{std::chrono::days{100'000}};

struct NamedFiles {
    std::set<fs::path> named;   // the named files, archives, and directories of chunks
    std::vector<fs::path> all;  // including the chunks of the directories, sorted
};

Result<NamedFiles> find_files(const std::vector<std::string>& names) {
    if (std::ranges::find(names, "-") != names.end()) {
        return fail(ErrorCode::bad_argument,
                    "a loop reads its files twice, so it cannot take them from standard input");
    }
    const auto inputs = InputFiles::find(names, InputFiles::all);
    if (!inputs) return pass_on(inputs);
    note_left_out(*inputs);
    NamedFiles files;
    std::set<fs::path> all;
    for (const InputFile& file : inputs->files()) {
        std::error_code error;
        const fs::path path = fs::canonical(file.path, error);
        if (error) {
            return fail(ErrorCode::not_found, "{}: {}", file.path.native(), error.message());
        }
        files.named.insert(path);
        if (file.chunks.empty()) all.insert(path);
        // This path is a directory of chunks, which are files below it.
        for (const fs::path& chunk : file.chunks)
            all.insert(path / chunk.filename());
    }
    files.all.assign(all.begin(), all.end());
    return files;
}

Result<fs::path> catalog_directory(const std::string& cache, const NamedFiles& files) {
    std::set<std::string> parents;
    for (const fs::path& path : files.named)
        parents.insert(path.parent_path().native());
    const std::string all = fmt::format("{}", fmt::join(parents, "\n"));
    const auto name =
        fmt::format("files-{:016x}", xxh3_64(std::as_bytes(std::span(all.data(), all.size()))));
    if (!cache.empty()) {
        std::error_code error;
        const fs::path below = fs::absolute(cache, error);
        if (error) return fail(ErrorCode::io, "{}: {}", cache, error.message());
        return below / ("." + name) / "catalog";
    }
    const auto loops = pipeline::loops_directory();
    if (!loops) return pass_on(loops);
    return *loops / name / "catalog";
}

Result<pipeline::InstanceLock> lock_state(const fs::path& state) {
    std::error_code error;
    fs::create_directories(state, error);
    if (error) return fail(ErrorCode::io, "{}: {}", state.native(), error.message());
    auto lock = pipeline::InstanceLock::acquire(state);
    for (int tries = 1; !lock && tries < lock_tries; ++tries) {
        std::this_thread::sleep_for(lock_pause);
        lock = pipeline::InstanceLock::acquire(state);
    }
    if (lock) return lock;
    return fail(ErrorCode::busy, "{}: another loop of these files is being made", state.native());
}

Status make_catalog(const fs::path& catalog, const NamedFiles& files, const LoopOptions& options,
                    Interrupt& interrupt) {
    const auto lock = lock_state(catalog.parent_path());
    if (!lock) return pass_on(lock);
    Progress bar("files", files.all.size(), !options.quiet);
    pipeline::RebuildOptions rebuild;
    rebuild.catalog = catalog;
    rebuild.drop = "/";
    rebuild.files = files.all;
    rebuild.threads = render::thread_count(options.scene);
    // An interrupted run leaves its rows in the catalog, so the next run continues.
    rebuild.progress = [&](std::size_t done, std::size_t all) {
        bar.show(done, all);
        if (!interrupt.flag()) return;
        bar.clear();
        fmt::print(stderr, "stormcellar: interrupted after {} of {} files\n", done, all);
        interrupt.end_by_signal();
    };
    const auto report = pipeline::rebuild_catalog(rebuild);
    if (!report) return pass_on(report);
    bar.clear();
    for (const Error& problem : report->problems)
        print_note(printable(problem.message));
    return {};
}

bool is_among(const std::set<fs::path>& files, const fs::path& path) {
    // The file itself, or a chunk.
    if (files.contains(path) || files.contains(path.parent_path())) return true;
    const auto names = member_names_in(path);
    return std::ranges::any_of(
        names, [&](const MemberName& name) { return files.contains(name.archive); });
}

Status say_rejected(const fs::path& catalog, const NamedFiles& files) {
    const auto reader = catalog::CatalogReader::open(catalog);
    if (!reader) return pass_on(reader);
    const auto rejected = rejected_among(files.named, *reader);
    if (!rejected) return pass_on(rejected);
    for (std::size_t i = 0; i < std::min(rejected->size(), most_rejected_named); ++i) {
        const pipeline::LeftOut& file = (*rejected)[i];
        print_note(printable(fmt::format("left out: {}: {}", file.path.native(), file.reason)));
    }
    if (rejected->size() > most_rejected_named)
        print_note(fmt::format("left out: {} more", rejected->size() - most_rejected_named));
    return {};
}

// Sets the stations and times that the options leave open.
Status take_range(const fs::path& catalog, LoopOptions& options) {
    auto reader = catalog::CatalogReader::open(catalog);
    if (!reader) return pass_on(reader);
    const auto stations = reader->station_names();
    if (!stations) return pass_on(stations);
    std::vector<std::string> names;
    UtcTime from = latest, to = earliest;
    for (const std::string& station : *stations) {
        const auto volumes = pipeline::archive_volumes(
            *reader, {station}, {earliest, latest, false, options.archive_files});
        if (!volumes) return pass_on(volumes);
        if (volumes->empty() || station.empty()) continue;
        names.push_back(station);
        from = std::min(from, volumes->front().start);
        for (const pipeline::ArchiveVolume& volume : *volumes)
            to = std::max(to, volume.end);
    }
    if (names.empty()) {
        return fail(ErrorCode::not_found, "none of the files holds a volume of a known station");
    }
    if (options.archive.stations.empty() && options.archive.bounds.empty()) {
        options.archive.stations = fmt::format("{}", fmt::join(names, ","));
    }
    if (options.range.from.empty()) options.range.from = format_utc(from);
    if (options.range.to.empty()) options.range.to = format_utc(to);
    return {};
}

}  // namespace

Result<std::vector<pipeline::LeftOut>> rejected_among(const std::set<fs::path>& files,
                                                      const catalog::CatalogReader& catalog) {
    const auto stations = catalog.station_names();
    if (!stations) return pass_on(stations);
    std::vector<pipeline::LeftOut> rejected;
    for (const std::string& station : *stations) {
        // One row is enough. The list also has rows of rejected files.
        const auto rows = catalog.list(station, {{}, {}, true, 1});
        if (!rows) return pass_on(rows);
        for (const catalog::CatalogEntry& row : *rows) {
            if (row.state == catalog::FileState::rejected && is_among(files, row.path))
                rejected.push_back({row.path, row.reason});
        }
    }
    return rejected;
}

Status catalog_files(LoopOptions& options, Interrupt& interrupt) {
    auto files = find_files(options.files);
    if (!files) return pass_on(files);
    const auto catalog = catalog_directory(options.cache, *files);
    if (!catalog) return pass_on(catalog);
    if (auto made = make_catalog(*catalog, *files, options, interrupt); !made) return made;
    if (auto said = say_rejected(*catalog, *files); !said) return said;
    options.archive.catalog = catalog->native();
    options.archive_files = std::move(files->named);
    return take_range(*catalog, options);
}

Status leave_files(const LoopOptions& options) {
    if (options.files.empty() || options.archive.keep_cache) return {};
    const fs::path state = fs::path(options.archive.catalog).parent_path();
    std::error_code error;
    fs::remove_all(state, error);
    if (error) return fail(ErrorCode::io, "{}: {}", state.native(), error.message());
    return {};
}

}  // namespace stormcellar::cli
