#include "pipeline/care/archive_fill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/parallel.h"
#include "pipeline/care/archive_frames.h"
#include "pipeline/drop/chunk_path.h"
#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/ingest.h"
#include "retrieve/derived/quality_note.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/catalog/read_cataloged.h"
#include "stormcellar/grid/grid_window.h"
#include "stormcellar/retrieve/hydrometeors.h"

namespace stormcellar::pipeline {
namespace {

// The grids of known volumes take 0.1 to 0.33 bytes for each cell. Volumes with much echo take
// more, and a small grid may be full of echo.
constexpr double bytes_a_cell = 0.5;
constexpr double cells_of_small_grid = 2e6;
// A frame uses only volumes that are at most this far from it.
constexpr std::chrono::minutes farthest_frame{30};
constexpr double bytes_a_file = 200e3;  // tables, and bricks that are not full

// Records the result of each file for many workers.
class Ledger {
  public:
    Ledger(FillReport& report, const FillProgress& progress)
        : report_(report), progress_(progress) {}

    void left_out(const std::filesystem::path& path, std::string reason) {
        const MutexLock lock(mutex_);
        report_.left_out.push_back({path, std::move(reason)});
        one_done();
    }
    void failed(Error error) {
        const MutexLock lock(mutex_);
        if (outcome_) outcome_ = tl::unexpected<Error>(std::move(error));
    }
    void made(const std::filesystem::path& path, const IngestOutcome& outcome) {
        const MutexLock lock(mutex_);
        ++report_.grids_made;
        if (!outcome.reason.empty()) report_.notes.push_back({path, outcome.reason});
        one_done();
    }
    [[nodiscard]] bool has_failed() const {
        const MutexLock lock(mutex_);
        return !outcome_;
    }
    // Returns the first error. Call it after all workers have ended.
    [[nodiscard]] Status outcome() {
        const MutexLock lock(mutex_);
        return std::move(outcome_);
    }

  private:
    void one_done() STORMCELLAR_REQUIRES(mutex_) {
        if (progress_) progress_(++done_);
    }

    mutable Mutex mutex_;
    FillReport& report_ STORMCELLAR_GUARDED_BY(mutex_);
    const FillProgress& progress_;
    std::size_t done_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    Status outcome_ STORMCELLAR_GUARDED_BY(mutex_);
};

// Returns a key for the files of a volume: the path, or, if the volume is in chunks, a key that all
// of its chunks share.
std::string key_of(const std::filesystem::path& path) {
    const auto chunk = ChunkPath::of(path);
    return chunk ? chunk->key : path.native();
}

// Checks that the files of some volumes are still the files that the catalog knows.
class CatalogedFiles {
  public:
    CatalogedFiles(const catalog::CatalogReader& catalog, const std::vector<ArchiveVolume>& volumes)
        : catalog_(catalog) {
        for (const ArchiveVolume& volume : volumes)
            stations_.emplace(key_of(volume.path), volume.station);
    }
    [[nodiscard]] Status check(const std::filesystem::path& path, std::uint64_t size_bytes,
                               std::uint64_t content_hash) const {
        const auto station = stations_.find(key_of(path));
        if (station == stations_.end()) return is_unknown(path);
        const auto row = catalog_.find_file(station->second, path);
        if (!row) return pass_on(row);
        if (!row->has_value()) return is_unknown(path);
        return catalog::check_cataloged(**row, size_bytes, content_hash);
    }

  private:
    static Status is_unknown(const std::filesystem::path& path) {
        return fail(ErrorCode::corrupt, "{}: came later and is not in the catalog", path.native());
    }

    const catalog::CatalogReader& catalog_;
    std::map<std::string, std::string> stations_;
};

// Returns true if the error concerns only the file, so that other files may go on.
bool is_of_file(const Error& error) {
    const bool may_not_read =
        error.code == ErrorCode::permission && error.cause() == Cause::configuration;
    return may_not_read || error.cause() == Cause::data;
}

std::string without_path(const std::filesystem::path& path, std::string message) {
    const std::string start = path.native() + ": ";
    return message.starts_with(start) ? message.substr(start.size()) : message;
}

void take_in(Ingestor& ingestor, const ArchiveVolume& volume, level2::Moment moment,
             Ledger& ledger) {
    const auto outcome = ingestor.ingest_again(volume.path);
    if (!outcome) {
        if (outcome.error().code == ErrorCode::not_found) {
            ledger.left_out(volume.path, "is gone");
        } else if (is_of_file(outcome.error())) {
            ledger.left_out(volume.path, without_path(volume.path, outcome.error().message));
        } else {
            ledger.failed(outcome.error());
        }
    } else if (outcome->result() == IngestResult::gridded) {
        ledger.made(volume.path, *outcome);
    } else {
        ledger.left_out(volume.path, reason_left_out(*outcome, moment));
    }
}

}  // namespace

IngestOptions ingest_options(const ArchiveOptions& options) {
    IngestOptions ingest;
    ingest.moments = {options.moment};
    ingest.derived = options.derived;
    ingest.spacing_m = options.spacing_m;
    ingest.nx = options.nx;
    ingest.ny = options.ny;
    ingest.levels_m = options.levels_m;
    if (options.domain) ingest.domains = {*options.domain};
    ingest.own_grids = !options.domain;
    ingest.frames = FramesWhen::asked_for;
    ingest.decode_threads = ingest.grid_threads = options.threads;
    return ingest;
}

bool is_derived_as(const retrieve::DerivedOptions& options,
                   const cache::GridDescription& description) {
    const std::vector<std::string>& notes = description.provenance.notes;
    if (!retrieve::is_of_quality(notes, options.quality)) return false;
    if (!retrieve::is_of_motion(notes, options.motion)) return false;
    const auto zero_c = retrieve::assumed_zero_c_in_notes(notes);
    if (zero_c && std::lround(*zero_c) != std::lround(options.zero_c_m)) return false;
    const std::string rung = retrieve::dealiasing_in_notes(notes);
    return rung.empty() || options.dealiasing == retrieve::Dealiasing::automatic ||
           rung == retrieve::dealiasing_name(options.dealiasing);
}

bool is_of_grid(const ArchiveOptions& options, const cache::GridDescription& description) {
    if (!is_derived_as(options.derived, description)) return false;
    const grid::GridSpec& spec = description.spec;
    if (options.domain) return grid::window_of(options.domain->spec, spec).has_value();
    const auto levels_m =
        options.levels_m.empty() ? grid::default_spec(0, 0).levels_m : options.levels_m;
    return spec.spacing_m == options.spacing_m && spec.nx == options.nx && spec.ny == options.ny &&
           spec.levels_m == levels_m;
}

std::string reason_left_out(const IngestOutcome& outcome, level2::Moment moment) {
    switch (outcome.result()) {
        case IngestResult::vanished:
            return "is gone";
        case IngestResult::no_moment:
            return outcome.reason.empty() ? fmt::format("holds no {} that reaches the grid",
                                                        level2::moment_name(moment))
                                          : outcome.reason;
        default:
            return outcome.reason.empty() ? "cannot be gridded" : outcome.reason;
    }
}

std::uint64_t bytes_of_grids(const ArchiveOptions& options, std::size_t volumes,
                             std::size_t frames) {
    double cells = 0, cells_a_file = 0;
    if (options.domain) {
        const grid::GridSpec& spec = options.domain->spec;
        const auto all = static_cast<double>(spec.cell_count());
        // Count only the part of the domain that one site reaches.
        const double side = 2 * grid::site_reach_m;
        const double reached = std::min(1.0, side / (spec.nx * spec.cell_width_m())) *
                               std::min(1.0, side / (spec.ny * spec.cell_height_m()));
        cells_a_file = all;
        cells = all * reached * static_cast<double>(volumes) + all * static_cast<double>(frames);
    } else {
        const std::size_t levels = options.levels_m.empty()
                                       ? grid::default_spec(0, 0).levels_m.size()
                                       : options.levels_m.size();
        cells_a_file = static_cast<double>(options.nx) * options.ny * static_cast<double>(levels);
        cells = cells_a_file * static_cast<double>(volumes);
    }
    const auto files = static_cast<double>(volumes + frames);
    const double echo = files * std::min(cells_a_file, cells_of_small_grid);
    return static_cast<std::uint64_t>((cells + echo) * bytes_a_cell + files * bytes_a_file);
}

ArchiveFill::ArchiveFill(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                         std::filesystem::path scratch, ArchiveOptions options)
    : catalog_(catalog),
      store_(store),
      scratch_(std::move(scratch)),
      options_(std::move(options)) {}

std::string ArchiveFill::domain_of(const ArchiveVolume& volume) const {
    return options_.domain ? options_.domain->name + "." + volume.station : volume.station;
}

// Returns true if the cache has the grid of the volume. A grid remains valid after its raw file was
// deleted. But if the raw file's modification time is later than the grid's, the raw file was
// replaced.
Result<bool> ArchiveFill::stands(const ArchiveVolume& volume) const {
    const auto path = store_.path_of(domain_of(volume), options_.moment, volume.start);
    if (!path) return pass_on(path);
    const auto file = cache::GridFile::open(*path);
    if (!file || !is_of_grid(options_, file->description())) return false;
    const auto made = stamp_of(*path);
    if (!made) return pass_on(made);
    const auto root = catalog::root_of(catalog_, volume.path);
    if (!root) return pass_on(root);
    const auto stamp = stamp_of(volume.path, *root);
    if (!stamp) return stamp.error().code == ErrorCode::not_found;
    return stamp->modified_ns <= made->modified_ns;
}

Result<std::vector<ArchiveVolume>> ArchiveFill::missing(
    const std::vector<ArchiveVolume>& volumes) const {
    std::vector<ArchiveVolume> left;
    for (const ArchiveVolume& volume : volumes) {
        const auto there = stands(volume);
        if (!there) return pass_on(there);
        if (!*there) left.push_back(volume);
    }
    return left;
}

Result<ArchiveFill::DueFrames> ArchiveFill::due(const std::vector<UtcTime>& instants,
                                                const std::vector<ArchiveVolume>& volumes) const {
    DueFrames found;
    for (const UtcTime instant : instants) {
        const bool is_near =
            std::any_of(volumes.begin(), volumes.end(), [&](const ArchiveVolume& volume) {
                return volume.start - farthest_frame <= instant &&
                       instant <= volume.end + farthest_frame;
            });
        if (!is_near) continue;
        found.instants.push_back(instant);
        const auto path = store_.path_of(options_.domain->name, options_.moment, instant);
        if (!path) return pass_on(path);
        std::error_code ignored;
        if (!std::filesystem::exists(*path, ignored)) ++found.missing;
    }
    return found;
}

// Returns the drop directory if all files are below it, else "/".
Result<std::filesystem::path> ArchiveFill::root_of(
    const std::vector<ArchiveVolume>& volumes) const {
    std::filesystem::path root = "/";
    for (const ArchiveVolume& volume : volumes) {
        auto of_this = catalog::root_of(catalog_, volume.path);
        if (!of_this || *of_this == "/") return of_this;
        root = std::move(*of_this);
    }
    return root;
}

Status ArchiveFill::fill(const std::vector<ArchiveVolume>& missing, const FillProgress& progress,
                         const std::atomic<bool>& stop, FillReport& report) {
    auto catalog = catalog::CatalogWriter::open(scratch_);
    if (!catalog) return pass_on(catalog);
    const auto root = root_of(missing);
    if (!root) return pass_on(root);
    const CatalogedFiles cataloged(catalog_, missing);
    IngestOptions ingest = ingest_options(options_);
    ingest.beneath = *root;
    ingest.check_read = [&](const std::filesystem::path& path, std::uint64_t size_bytes,
                            std::uint64_t content_hash) {
        return cataloged.check(path, size_bytes, content_hash);
    };
    Ingestor ingestor(*catalog, store_, std::move(ingest));
    Ledger ledger(report, progress);
    const int workers = std::clamp(options_.threads, 1, most_workers);
    for_each_piece(static_cast<int>(missing.size()), workers, [&](int piece) {
        if (stop || ledger.has_failed()) return;
        take_in(ingestor, missing[static_cast<std::size_t>(piece)], options_.moment, ledger);
    });
    const auto by_path = [](const LeftOut& a, const LeftOut& b) { return a.path < b.path; };
    std::sort(report.left_out.begin(), report.left_out.end(), by_path);
    std::sort(report.notes.begin(), report.notes.end(), by_path);
    return ledger.outcome();
}

Status ArchiveFill::make_frames(const std::vector<UtcTime>& instants, const FillProgress& progress,
                                const std::atomic<bool>& stop, FillReport& report) {
    if (!options_.domain) return {};
    return pipeline::make_frames(store_, *options_.domain, options_.moment, instants,
                                 options_.threads, progress, stop, report);
}

}  // namespace stormcellar::pipeline
