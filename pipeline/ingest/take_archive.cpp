#include <algorithm>
#include <chrono>
#include <utility>

#include "base/beneath.h"
#include "base/checksum.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/ingest/handlers.h"
#include "pipeline/ingest/take_volumes.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/member_name.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;

// Returns the limits of an archive. A radar's day has some 300 volumes in 3 GB. The memory limit is
// little above the largest member. Level II files are packed already, so an archive of them unpacks
// to about its own size; uncompressed Level II files in an archive unpack to some ten times its
// size.
archive::Limits limits_of(const IngestOptions& options) {
    archive::Limits limits;
    limits.archive_bytes = std::uint64_t{8} << 30;
    limits.members = 10'000;
    limits.member_bytes = std::min(options.most_file_bytes, std::uint64_t{96} << 20);
    limits.all_bytes = std::uint64_t{8} << 30;
    limits.expansion = 20;
    limits.time = std::chrono::seconds{60};  // shorter than the watchdog's timeout
    limits.nesting = 0;
    limits.small_codecs = true;
    return limits;
}

// Adds the outcome of a member to the outcome of the archive.
void add(const IngestOutcome& member, IngestOutcome& all) {
    const auto append = [](const auto& from, auto& to) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(member.grids, all.grids);
    append(member.partials, all.partials);
    append(member.frames, all.frames);
    all.read_s += member.read_s;
    all.decode_s += member.decode_s;
    all.grid_s += member.grid_s;
    all.commit_s += member.commit_s;
    all.mosaic_s += member.mosaic_s;
    all.not_kept += member.not_kept;
    all.partial = all.partial || member.partial;
    all.newest_radial = std::max(all.newest_radial, member.newest_radial);
    if (!member.station.empty()) all.station = member.station;
    if (member.result() == IngestResult::gridded) all.ending = ended::Gridded{};
}

std::string reason_of(const OpenArchive& open) {
    std::string reason = fmt::format("{}{} ingested, {} rejected", catalog::reason_of_archive,
                                     open.taken, open.rejected);
    if (open.known > 0) reason += fmt::format(", {} already known", open.known);
    for (const archive::LeftOut& one : open.reader.left_out()) {
        reason += fmt::format("; {}{}{}", one.name, one.name.empty() ? "" : " ", one.reason);
        if (reason.size() > 400) break;
    }
    return reason;
}

// Returns the member's modification time, or the archive's if the member has none.
std::int64_t modified_ns_of(const archive::Member& member, const FileStamp& archive_stamp) {
    if (!member.modified) return archive_stamp.modified_ns;
    return std::chrono::nanoseconds{member.modified->time_since_epoch()}.count();
}

Result<IngestOutcome> take_member(IngestContext& context, const fs::path& archive,
                                  const FileStamp& archive_stamp, const archive::Member& member) {
    FileFacts facts;
    facts.path = member_path(archive, member.name);
    facts.station = station_of_file_name(fs::path{member.name});
    facts.size_bytes = member.bytes.size();
    facts.modified_ns = modified_ns_of(member, archive_stamp);
    facts.content_hash = xxh3_64(member.bytes);
    if (context.options.check_read) {
        const Status wanted =
            context.options.check_read(facts.path, facts.size_bytes, facts.content_hash);
        if (!wanted) return context.reject(facts, wanted.error(), {});
    }
    auto decoded = level2::decode(member.bytes, context.decode_options_for(facts.station));
    if (decoded) {
        return TakeVolumes(context, std::move(facts), {})
            .take(std::move(*decoded), MayBePartial::yes);
    }
    if (is_shortage(decoded.error().code)) return pass_on(decoded);
    return context.reject(facts, decoded.error(), {});
}

}  // namespace

Result<std::optional<OpenArchive>> TakeArchive::open(IngestContext& context, const fs::path& path,
                                                     const FileStamp& stamp) {
    std::optional<OpenArchive> archive = context.archives.take(path, stamp);
    if (archive) return archive;
    const auto opened = open_beneath(context.options.beneath, path);
    if (!opened) return pass_on(opened);
    Descriptor file{*opened};
    auto reader = archive::ArchiveReader::open(file.number(), limits_of(context.options));
    if (reader) archive.emplace(OpenArchive{path, stamp, std::move(file), std::move(*reader)});
    return archive;
}

Result<IngestOutcome> TakeArchive::take() {
    if (!file_.may_be_partial() && !open_.reader.may_have_its_end())
        return wait("the archive has no end yet");
    if (context_.store == nullptr) {
        outcome_.ending = ended::Registered{};
    } else {
        outcome_.ending = ended::NoMoment{};
    }
    const auto& turn = context_.options.archive_turn;
    const auto start = std::chrono::steady_clock::now();
    while (const auto member = open_.reader.next()) {
        if (Status taken = take_next(*member); !taken) return pass_on(taken);
        if (turn && std::chrono::steady_clock::now() - start > *turn) {
            outcome_.ending = ended::Incomplete{.has_next_turn = true};
            outcome_.reason =
                fmt::format("an archive: {} ingested so far", open_.taken + open_.known);
            context_.archives.keep(std::move(open_));
            return std::move(outcome_);
        }
    }
    return settle();
}

// Records that the archive is incomplete. The results of its members stay.
Result<IngestOutcome> TakeArchive::wait(std::string reason) {
    outcome_.ending = ended::Incomplete{};
    outcome_.reason = std::move(reason);
    return std::move(outcome_);
}

Status TakeArchive::take_next(const archive::Member& member) {
    const fs::path path = member_path(open_.path, member.name);
    open_.met.insert(path);
    const auto settled =
        context_.catalog.is_settled(path, member.bytes.size(), modified_ns_of(member, open_.stamp));
    if (settled && *settled) {
        ++open_.known;
        return {};
    }
    const auto one = take_member(context_, open_.path, open_.stamp, member);
    if (!one) return pass_on(one);
    ++(one->result() == IngestResult::rejected ? open_.rejected : open_.taken);
    add(*one, outcome_);
    return {};
}

Result<IngestOutcome> TakeArchive::settle() {
    const auto after = stamp_of(file_.path, context_.options.beneath);
    if (open_.reader.is_unreadable()) {
        return fail(ErrorCode::io, "{}: {}", file_.path.native(), open_.reader.why_ended());
    }
    const bool is_cut = open_.reader.is_cut();
    if (!file_.may_be_partial() && is_cut) return wait("the archive has no end yet");
    if (!after || *after != open_.stamp) return wait("the archive changed while it was read");
    FileFacts facts = facts_unread(file_.path, open_.stamp, station_of_file_name(file_.path));
    facts.state = is_cut ? FileState::partial : FileState::complete;
    facts.reason = reason_of(open_);
    outcome_.reason = facts.reason;
    if (open_.reader.why_ended().empty()) {
        const auto marked = context_.catalog.mark_former_members(open_.path, open_.met);
        if (!marked) return pass_on(marked);
    }
    if (Status stored = context_.record(facts); !stored) return pass_on(stored);
    return std::move(outcome_);
}

Result<IngestOutcome> take_member_again(IngestContext& context, const MemberName& name,
                                        const FileStamp& archive_stamp,
                                        const ReadCheck& is_the_same) {
    const auto opened = open_beneath(context.options.beneath, name.archive);
    if (!opened) return pass_on(opened);
    const Descriptor file{*opened};
    const auto member =
        archive::find_member(file.number(), name.member, limits_of(context.options));
    const fs::path path = member_path(name.archive, name.member);
    if (!member) return fail(member.error().code, "{}: {}", path.native(), member.error().message);
    if (is_the_same) {
        const Status same = is_the_same(path, member->bytes.size(), xxh3_64(member->bytes));
        if (!same) return pass_on(same);
    }
    return take_member(context, name.archive, archive_stamp, *member);
}

}  // namespace stormcellar::pipeline
