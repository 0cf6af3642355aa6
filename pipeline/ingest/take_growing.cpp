#include <chrono>
#include <utility>

#include "base/steady_time.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/ingest/handlers.h"
#include "pipeline/ingest/show_living.h"
#include "pipeline/ingest/take_volumes.h"

namespace stormcellar::pipeline {

TakeGrowing::TakeGrowing(IngestContext& context, const OfferedFile& file, const Growing& growing)
    : context_(context),
      file_(file),
      growing_(growing),
      followed_(growing.followed),
      facts_(facts_unread(file.path, growing.stamp, station_of_file_name(file.path))),
      station_(context.taken_station(facts_.station)) {}

Result<IngestOutcome> TakeGrowing::take() {
    const std::filesystem::path& beneath = context_.options.beneath;
    if (!followed_) begin();
    if (!followed_) {
        // A file that cannot be followed is read only when it has ended or has been quiet, because
        // reading it at every change would be useless.
        if (FollowedFile::has_ended(file_.path, growing_.start, beneath)) return take_whole();
        return context_.wait_unread(std::move(facts_), std::move(outcome_));
    }
    if (!followed_->kept().facts.station.empty())
        station_ = context_.taken_station(followed_->kept().facts.station);
    const auto start = std::chrono::steady_clock::now();
    const bool has_ended = read() && followed_->has_ended();
    outcome_.decode_s = seconds_since(start);
    outcome_.given_up = context_.living->take_given_up();
    if (!followed_->is_whole() || !context_.living->grew(file_.path, *followed_, station_)) {
        const bool was_given_up = context_.living->find(file_.path) == nullptr;
        if (was_given_up && !file_.may_be_partial())
            return context_.wait_unread(std::move(facts_), std::move(outcome_));
        context_.living->forget(file_.path);
        return take_whole();
    }
    if (!has_ended && !file_.may_be_partial()) return show();
    context_.living->forget(file_.path);
    return finish(start);
}

// Begins to follow the file, unless its station is not accepted.
void TakeGrowing::begin() {
    const std::string& header_station = growing_.start.station;
    const std::string& claimed = header_station.empty() ? facts_.station : header_station;
    station_ = context_.taken_station(claimed);
    if (claimed.empty() || !station_.empty())
        followed_ = context_.living->begin(file_.path, facts_.station, station_);
}

// Reads the appended data. Returns false if the file cannot be followed.
bool TakeGrowing::read() {
    const auto may_read_on = [&] {
        return context_.living->grew(file_.path, *followed_, station_);
    };
    const Status read = followed_->read_to(growing_.stamp.size_bytes, may_read_on);
    if (!read && read.error().code == ErrorCode::over_budget) context_.living->give_up(file_.path);
    return read.has_value();
}

// Records the state of a volume that has not ended, in the catalog and as living grids.
Result<IngestOutcome> TakeGrowing::show() {
    const ShelvedVolume& kept = followed_->kept();
    outcome_.ending = ended::Incomplete{.is_followed = true};
    outcome_.goes_on = !kept.places.empty();
    // Set the station even if no sweep is complete, because data of the station have come.
    outcome_.station = kept.facts.station.empty() ? facts_.station : kept.facts.station;
    if (!followed_->news().any || followed_->holds_several()) return std::move(outcome_);
    facts_.station = kept.facts.station;
    facts_.content_hash = followed_->content_hash();
    facts_.state = catalog::FileState::seen;
    catalog::VolumeFacts volume_facts = facts_of(kept.facts, false);
    volume_facts.sweep_count = static_cast<int>(kept.places.size());
    volume_facts.radial_count = static_cast<int>(followed_->radials());
    volume_facts.end_time = followed_->newest();
    facts_.volumes.push_back(volume_facts);
    if (Status stored = context_.record(facts_); !stored) return pass_on(stored);
    outcome_.station = facts_.station;
    outcome_.volume_time = volume_facts.start_time;
    outcome_.newest_radial = volume_facts.end_time;
    const auto shown =
        show_living(context_, kept, followed_->news(), facts_.path.filename().string(), outcome_);
    if (!shown) return pass_on(shown);
    if (*shown) followed_->set_shown();
    return std::move(outcome_);
}

// Grids the volume, which has ended or has been quiet. Its file is no longer followed.
Result<IngestOutcome> TakeGrowing::finish(std::chrono::steady_clock::time_point start) {
    facts_.content_hash = followed_->content_hash();
    auto decoded = followed_->finish();
    outcome_.decode_s = seconds_since(start);
    if (!decoded) return take_whole();
    const auto partial = file_.may_be_partial() ? MayBePartial::yes : MayBePartial::no;
    TakeVolumes volumes(context_, std::move(facts_), std::move(outcome_));
    volumes.set_use_dealiased(
        [&](const level2::Volume& dealiased) { followed_->keep_dealiased(dealiased); });
    auto taken = volumes.take(std::move(*decoded), partial);
    if (taken && !taken->station.empty()) context_.living->keep_last(followed_->take_kept());
    return taken;
}

Result<IngestOutcome> TakeGrowing::take_whole() {
    return pipeline::take(context_, file_, Whole{growing_.stamp});
}

}  // namespace stormcellar::pipeline
