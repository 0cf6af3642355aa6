// Volumes that are taken in while they grow: appended to one file, or one file a chunk.
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "base/stopwatch.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/ingest/ingest_parts.h"
#include "pipeline/keep/keep_rule.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;
using Clock = std::chrono::steady_clock;

// The chunk, and with the first one all that lie beside it.
Result<ChunkVolume::Added> add_to(ChunkVolume& volume, const ChunkPath& chunk,
                                  const FileStamp& stamp) {
    auto added = volume.add(chunk, stamp);
    if (!added || *added == ChunkVolume::Added::not_ours || volume.is_loaded) return added;
    if (const Status all = volume.add_siblings(chunk); !all) return pass_on(all);
    volume.is_loaded = true;
    return added;
}

// Of a chunk that was added.
FileFacts facts_of(const ChunkVolume& volume, const ChunkPath& chunk, const FileStamp& stamp) {
    FileFacts facts;
    facts.path = chunk.path;
    facts.size_bytes = stamp.size_bytes;
    facts.modified_ns = stamp.modified_ns;
    facts.content_hash = volume.files().at(chunk.path).content_hash;
    facts.station = volume.station();
    if (facts.station.empty()) facts.station = station_of_path(chunk.path);
    facts.state = FileState::seen;
    return facts;
}

// Of a chunk that was not read.
FileFacts facts_unread(const fs::path& path, const FileStamp& stamp) {
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_path(path);
    facts.size_bytes = stamp.size_bytes;
    facts.modified_ns = stamp.modified_ns;
    return facts;
}

}  // namespace

Result<bool> Ingestor::Impl::show_living(const KeptVolume& kept, LivingNews news,
                                         const std::string& source_file, std::int64_t modified_ns,
                                         IngestOutcome& outcome) {
    // A grid is named by the start in the header: without it, it would stay beside the whole one.
    if (!kept.facts.header) return false;
    if (!living || !options.own_grids || taken_station(kept.facts.station).empty()) return false;
    // With the next sweep, or when the volume has ended. Low sweeps are what is looked at first.
    if (!news.low && options.living.has_time && !options.living.has_time()) {
        outcome.living_left_out = true;
        return false;
    }
    const auto last = living->last_of(kept.facts.station);
    std::size_t standing = 0;
    const auto volume = living_volume(kept, last.get(), &standing);
    // Its grid would be named by another time than the whole volume's, and stay beside it.
    if (!volume || volume->start_time() != kept.facts.header->time()) return true;
    GridSource source{source_file, modified_ns, true};
    source.notes.push_back(fmt::format("{}{} sweeps have come, {} of the last volume stand",
                                       living_note, volume->sweeps.size() - standing, standing));
    const Status shown =
        site_grids->keep_living(*volume, source, share_of(options.grid_threads), outcome);
    if (!shown && shown.error().cause() != Cause::data) return pass_on(shown);
    return true;
}

// What has come of a volume that has not ended: for the catalog, and as a living grid.
Result<IngestOutcome> Ingestor::Impl::show_file(const FileFacts& file, LivingFile& living_file,
                                                IngestOutcome outcome) {
    outcome.result = IngestResult::incomplete;
    outcome.followed = true;
    const KeptVolume& kept = living_file.kept();
    outcome.goes_on = !kept.places.empty();
    // Also where no sweep is complete yet: something has come of the station.
    outcome.station = kept.facts.station.empty() ? file.station : kept.facts.station;
    if (!living_file.news().any || living_file.holds_several()) return outcome;
    FileFacts facts = file;
    facts.station = kept.facts.station;
    facts.content_hash = living_file.content_hash();
    facts.state = FileState::seen;
    catalog::VolumeFacts volume_facts = facts_of(kept.facts, false);
    volume_facts.sweep_count = static_cast<int>(kept.places.size());
    volume_facts.radial_count = static_cast<int>(living_file.radials());
    volume_facts.end_time = living_file.newest();
    facts.volumes.push_back(volume_facts);
    if (Status stored = record(facts); !stored) return pass_on(stored);
    outcome.station = facts.station;
    outcome.volume_time = volume_facts.start_time;
    outcome.newest_radial = volume_facts.end_time;
    const auto shown = show_living(kept, living_file.news(), facts.path.filename().string(),
                                   facts.modified_ns, outcome);
    if (!shown) return pass_on(shown);
    if (*shown) living_file.set_shown();
    return outcome;
}

// Its row says that it is there, and no more.
Result<IngestOutcome> Ingestor::Impl::wait_unread(FileFacts facts, IngestOutcome outcome) {
    outcome.result = IngestResult::incomplete;
    facts.station = taken_station(facts.station);
    facts.state = FileState::seen;
    const auto known = catalog.is_known(facts.path);
    if (!known) return pass_on(known);
    if (*known) return outcome;
    if (Status noted = catalog.note_file(facts); !noted) return pass_on(noted);
    return outcome;
}

std::optional<Result<IngestOutcome>> Ingestor::Impl::follow(const fs::path& path,
                                                            const FileStamp& before,
                                                            bool finish_partial,
                                                            IngestOutcome outcome) {
    if (!living || !before.regular) return std::nullopt;
    std::shared_ptr<LivingFile> file = living->find(path);
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_file_name(path);
    facts.size_bytes = before.size_bytes;
    facts.modified_ns = before.modified_ns;
    std::string station = taken_station(facts.station);
    if (!file && !finish_partial) {
        const auto growing = LivingFile::growing(path, options.beneath);
        if (!growing) return std::nullopt;
        const std::string& claimed = growing->station.empty() ? facts.station : growing->station;
        station = taken_station(claimed);
        if (claimed.empty() || !station.empty()) file = living->begin(path, facts.station, station);
        // What is not followed is read when it has ended or has been quiet, and not before: again
        // and again it would be read in vain.
        if (!file && LivingFile::has_ended(path, *growing, options.beneath)) return std::nullopt;
        if (!file) return wait_unread(std::move(facts), std::move(outcome));
    }
    if (!file) return std::nullopt;
    if (!file->kept().facts.station.empty()) station = taken_station(file->kept().facts.station);
    const auto start = Clock::now();
    const auto may_read_on = [&] { return living->grew(path, *file, station); };
    const Status read = file->read_to(before.size_bytes, may_read_on);
    if (!read && read.error().code == ErrorCode::over_budget) living->give_up(path);
    const bool has_ended = read && file->has_ended();
    outcome.decode_s = seconds_since(start);
    outcome.given_up = living->take_given_up();
    if (!file->is_whole() || !living->grew(path, *file, station)) {
        const bool is_given_up = living->find(path) == nullptr;
        if (is_given_up && !finish_partial)
            return wait_unread(std::move(facts), std::move(outcome));
        living->forget(path);
        return std::nullopt;
    }
    if (!has_ended && !finish_partial) return show_file(facts, *file, std::move(outcome));
    living->forget(path);
    facts.content_hash = file->content_hash();
    auto decoded = file->finish();
    outcome.decode_s = seconds_since(start);
    if (!decoded) return std::nullopt;
    auto taken = take_in(std::move(facts), std::move(*decoded), finish_partial, outcome);
    if (taken && !taken->station.empty()) living->keep_last(file->take_kept());
    return taken;
}

// A volume that found no place is read at once when its end has come.
ChunkVolumes::Expected Ingestor::Impl::expected_of(const ChunkPath& chunk, Finish finish) const {
    using Expected = ChunkVolumes::Expected;
    switch (finish) {
        case Finish::as_it_is:
            return Expected::nothing;
        case Finish::when_quiet:
            return chunks->may_be_due(chunk) ? Expected::nothing : Expected::more;
        case Finish::when_it_ends:
            break;
    }
    const bool is_end = chunk.name.kind == level2::ChunkKind::end;
    return is_end ? Expected::its_end_is_there : Expected::more;
}

// One chunk of the volume, the newest, is asked for again in the name of all.
Result<IngestOutcome> Ingestor::Impl::wait_for_place(const ChunkPath& chunk, const FileStamp& stamp,
                                                     IngestOutcome outcome) {
    outcome.instead_of = chunks->wait_for_place(chunk);
    return wait_unread(facts_unread(chunk.path, stamp), std::move(outcome));
}

std::optional<Result<IngestOutcome>> Ingestor::Impl::take_chunk(const ChunkPath& chunk,
                                                                const FileStamp& before,
                                                                Finish finish,
                                                                IngestOutcome outcome,
                                                                const ReadCheck& is_the_same) {
    if (!before.regular) return std::nullopt;
    const std::string path_station = taken_station(station_of_path(chunk.path));
    const auto expected = expected_of(chunk, finish);
    std::shared_ptr<ChunkVolume> volume = chunks->find(chunk, path_station, expected);
    outcome.given_up = chunks->take_given_up();
    if (!volume) return wait_for_place(chunk, before, std::move(outcome));
    std::unique_lock lock(volume->mutex);
    while (volume->is_finished) {  // by another worker, while we waited for it
        const auto settled = catalog.is_settled(chunk.path, before.size_bytes, before.modified_ns);
        if (!settled) return pass_on(settled);
        if (*settled) {
            outcome.result = IngestResult::unchanged;
            return outcome;
        }
        lock.unlock();
        chunks->forget(chunk, volume.get());
        volume = chunks->find(chunk, path_station, expected);
        if (!volume) return wait_for_place(chunk, before, std::move(outcome));
        lock = std::unique_lock(volume->mutex);
    }
    const auto start = Clock::now();
    const auto added = add_to(*volume, chunk, before);
    if (!added) return pass_on(added);
    if (*added == ChunkVolume::Added::not_ours) {
        if (volume->files().empty()) chunks->forget(chunk, volume.get());
        return std::nullopt;
    }
    outcome.decode_s = seconds_since(start);
    outcome.result = IngestResult::incomplete;
    if (*added == ChunkVolume::Added::unfinished) {
        if (finish != Finish::when_it_ends) return std::nullopt;
        return outcome;
    }
    volume->add_what_is_missing(chunk);
    const FileFacts facts = facts_of(*volume, chunk, before);
    outcome.station = taken_station(facts.station);
    if (volume->is_whole() || finish == Finish::as_it_is ||
        (finish == Finish::when_quiet && volume->is_due())) {
        // A volume that could not be stored is put together again. Until then it is found, and
        // waited for: two of one volume would overwrite each other's rows.
        volume->is_finished = true;
        auto finished = finish_chunks(*volume, facts.station, std::move(outcome), is_the_same);
        // Nobody need ask for it any more.
        if (finished) finished->instead_of = volume->take_former_waiter();
        chunks->forget(chunk, volume.get());
        return finished;
    }
    return show_chunk(chunk, facts, *volume, std::move(outcome));
}

// Its volume goes on growing.
Result<IngestOutcome> Ingestor::Impl::show_chunk(const ChunkPath& chunk, const FileFacts& facts,
                                                 ChunkVolume& volume, IngestOutcome outcome) {
    if (Status stored = record(facts); !stored) return pass_on(stored);
    volume.is_finished = !chunks->grew(chunk, volume, taken_station(facts.station));
    outcome.goes_on = !volume.is_finished && volume.has_sweeps();
    outcome.given_up += chunks->take_given_up();
    if (volume.news().any && volume.kept() != nullptr) {
        const auto shown =
            show_living(*volume.kept(), volume.news(), volume.first_file().filename().string(),
                        facts.modified_ns, outcome);
        if (!shown) return pass_on(shown);
        if (*shown) volume.set_shown();
    }
    // One of a volume is waited for in the name of all.
    if (volume.waits(chunk)) {
        outcome.instead_of = volume.take_former_waiter();
    } else {
        outcome.result = IngestResult::registered;
    }
    return outcome;
}

bool Ingestor::Impl::is_waited_for(const fs::path& path) {
    const auto chunk = chunks ? ChunkPath::of(path) : std::nullopt;
    const auto volume = chunk ? chunks->find_known(*chunk) : nullptr;
    if (!volume) return false;
    const std::scoped_lock lock(volume->mutex);
    return !volume->is_finished && volume->is_waiter(path);
}

// What was in it has been decoded. The volume goes on in its name until it is due, as others that
// come later may still make it whole.
std::optional<Result<IngestOutcome>> Ingestor::Impl::take_gone_chunk(const ChunkPath& chunk,
                                                                     Finish finish,
                                                                     IngestOutcome outcome) {
    const auto volume = chunks->find_known(chunk);
    if (!volume) return std::nullopt;
    const std::scoped_lock lock(volume->mutex);
    if (volume->is_finished || !volume->is_waiter(chunk.path)) return std::nullopt;
    const std::string station = facts_of(*volume, chunk, {}).station;
    outcome.station = taken_station(station);
    outcome.reason = "the file that waited for its volume was deleted";
    if (finish == Finish::when_it_ends || (finish == Finish::when_quiet && !volume->is_due())) {
        outcome.result = IngestResult::incomplete;
        return outcome;
    }
    volume->is_finished = true;
    const std::string reason = outcome.reason;
    auto finished = finish_chunks(*volume, station, std::move(outcome));
    chunks->forget(chunk, volume.get());
    if (!finished) return finished;
    finished->reason += (finished->reason.empty() ? "" : "; ") + reason;
    for (const auto& [path, file] : volume->files()) {
        const auto stamp = stamp_of(path, options.beneath);
        if (stamp || stamp.error().code != ErrorCode::not_found) continue;
        if (Status marked = mark_gone(path); !marked) return pass_on(marked);
    }
    return finished;
}

// The first chunk's row stands for the volume; those of the others say that they were taken in.
Result<IngestOutcome> Ingestor::Impl::finish_chunks(ChunkVolume& volume, const std::string& station,
                                                    IngestOutcome outcome,
                                                    const ReadCheck& is_the_same) {
    const auto start = Clock::now();
    const std::filesystem::path first = volume.first_file();
    FileFacts facts;
    facts.station = station;
    std::vector<FileFacts> others;
    for (const auto& [path, file] : volume.files()) {
        facts.path = path;
        facts.size_bytes = file.stamp.size_bytes;
        facts.modified_ns = file.stamp.modified_ns;
        facts.content_hash = file.content_hash;
        facts.state = FileState::complete;
        if (path != first && file.is_whole) others.push_back(facts);
    }
    const auto& file = volume.files().at(first);
    facts.path = first;
    facts.size_bytes = file.stamp.size_bytes;
    facts.modified_ns = file.stamp.modified_ns;
    facts.content_hash = file.content_hash;
    for (const auto& [path, read] : volume.files()) {
        if (!is_the_same) break;
        const Status same = is_the_same(path, read.stamp.size_bytes, read.content_hash);
        if (!same) return pass_on(same);
    }
    for (const auto& [path, read] : volume.files()) {
        if (!options.check_read) break;
        const Status wanted = options.check_read(path, read.stamp.size_bytes, read.content_hash);
        if (!wanted) return reject(facts, wanted.error(), outcome);
    }
    outcome.missing_chunks = volume.missing_numbers();
    auto decoded = volume.finish();
    outcome.decode_s += seconds_since(start);
    // What was put aside cannot be read back, or there is no memory for it: the files are not to
    // blame, and are read again.
    if (!decoded && decoded.error().cause() == Cause::system) return pass_on(decoded);
    if (!decoded) {
        for (FileFacts& other : others) {
            other.state = FileState::rejected;
            other.reason = decoded.error().message;
        }
        if (Status settled = catalog.register_files(taken_station(station), others); !settled) {
            return pass_on(settled);
        }
        return reject(facts, decoded.error(), outcome);
    }
    auto taken = take_in(std::move(facts), std::move(*decoded), true, std::move(outcome));
    if (!taken) return taken;
    if (Status settled = catalog.register_files(taken_station(station), others); !settled) {
        return pass_on(settled);
    }
    if (living && !taken->station.empty()) living->keep_last(volume.take_kept());
    return taken;
}

}  // namespace stormcellar::pipeline
