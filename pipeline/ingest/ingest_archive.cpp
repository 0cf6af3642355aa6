// Archives in the drop directory: each member is a file of its own to the catalog and the cache.
#include <algorithm>
#include <mutex>
#include <utility>

#include "base/beneath.h"
#include "base/checksum.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/ingest/ingest_parts.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/member_name.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using catalog::FileFacts;
using catalog::FileState;

// A day of a radar has some 300 volumes in 3 GB. What an archive may claim here is no more than
// what a file may: memory for one member and little else. Level II is packed already, so a packed
// archive unpacks to about its own size; raw messages inside it, to some ten times that.
archive::Limits limits_of(const IngestOptions& options) {
    archive::Limits limits;
    limits.members = 10'000;
    limits.member_bytes = std::min(options.most_file_bytes, std::uint64_t{96} << 20);
    limits.all_bytes = std::uint64_t{8} << 30;
    limits.expansion = 20;
    limits.nesting = 0;
    limits.small_codecs = true;
    return limits;
}

// So many archives that wait for their next turn stay open; others are gone through again.
constexpr std::size_t most_open_archives = 4;

// Adds what became of a member to what becomes of its archive.
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
    if (member.result == IngestResult::gridded) all.result = IngestResult::gridded;
}

std::string reason_of(const OpenArchive& open) {
    std::string reason =
        fmt::format("an archive: {} taken in, {} rejected", open.taken, open.rejected);
    if (open.known > 0) reason += fmt::format(", {} known already", open.known);
    for (const archive::LeftOut& one : open.reader.left_out()) {
        reason += fmt::format("; {}{}{}", one.name, one.name.empty() ? "" : " ", one.reason);
        if (reason.size() > 400) break;
    }
    return reason;
}

}  // namespace

Result<IngestOutcome> Ingestor::Impl::take_member(const fs::path& archive, const FileStamp& stamp,
                                                  const archive::Member& member) {
    FileFacts facts;
    facts.path = member_path(archive, member.name);
    facts.station = station_of_file_name(fs::path{member.name});
    facts.size_bytes = member.bytes.size();
    facts.modified_ns = member.modified
                            ? std::chrono::nanoseconds{member.modified->time_since_epoch()}.count()
                            : stamp.modified_ns;
    facts.content_hash = xxh3_64(member.bytes);
    IngestOutcome outcome;
    if (options.check_read) {
        const Status wanted = options.check_read(facts.path, facts.size_bytes, facts.content_hash);
        if (!wanted) return reject(facts, wanted.error(), outcome);
    }
    auto decoded = level2::decode(member.bytes, decode_options_for(facts.station));
    if (decoded) return take_in(std::move(facts), std::move(*decoded), true, outcome);
    if (is_shortage(decoded.error().code)) return pass_on(decoded);
    return reject(facts, decoded.error(), outcome);
}

Result<IngestOutcome> Ingestor::Impl::take_member_again(const MemberName& name,
                                                        const FileStamp& stamp,
                                                        const ReadCheck& is_the_same) {
    const auto opened = open_beneath(options.beneath, name.archive);
    if (!opened) return pass_on(opened);
    const Descriptor file{*opened};
    const auto member = archive::find_member(file.number(), name.member, limits_of(options));
    const fs::path path = member_path(name.archive, name.member);
    if (!member) {
        return fail(ErrorCode::not_found, "{}: the archive does not have it any more",
                    path.native());
    }
    if (is_the_same) {
        const Status same = is_the_same(path, member->bytes.size(), xxh3_64(member->bytes));
        if (!same) return pass_on(same);
    }
    return take_member(name.archive, stamp, *member);
}

std::optional<OpenArchive> Ingestor::Impl::open_archive(const fs::path& path,
                                                        const FileStamp& stamp) {
    if (auto waiting = archives.take(path, stamp)) return waiting;
    const auto opened = open_beneath(options.beneath, path);
    if (!opened) return std::nullopt;
    Descriptor file{*opened};
    auto reader = archive::ArchiveReader::open(file.number(), limits_of(options));
    if (!reader) return std::nullopt;
    return OpenArchive{path, stamp, std::move(file), std::move(*reader)};
}

Status Ingestor::Impl::take_next(OpenArchive& open, const archive::Member& member,
                                 IngestOutcome& all) {
    const auto settled = catalog.is_settled(
        member_path(open.path, member.name), member.bytes.size(),
        member.modified ? std::chrono::nanoseconds{member.modified->time_since_epoch()}.count()
                        : open.stamp.modified_ns);
    if (settled && *settled) {
        ++open.known;
        return {};
    }
    const auto one = take_member(open.path, open.stamp, member);
    if (!one) return pass_on(one);
    ++(one->result == IngestResult::rejected ? open.rejected : open.taken);
    add(*one, all);
    return {};
}

std::optional<Result<IngestOutcome>> Ingestor::Impl::take_archive(const fs::path& path,
                                                                  const FileStamp& before,
                                                                  bool finish_partial,
                                                                  const IngestOutcome& outcome) {
    auto open = open_archive(path, before);
    if (!open) return std::nullopt;
    IngestOutcome all = outcome;
    const auto wait = [&all](std::string reason) {
        all.result = IngestResult::incomplete;
        all.reason = std::move(reason);
        return all;
    };
    if (!finish_partial && !open->reader.may_have_its_end())
        return wait("an archive without an end");
    all.result = store == nullptr ? IngestResult::registered : IngestResult::no_moment;
    const auto start = std::chrono::steady_clock::now();
    while (const auto member = open->reader.next()) {
        if (Status taken = take_next(*open, *member, all); !taken) {
            return Result<IngestOutcome>{pass_on(taken)};
        }
        if (options.archive_turn &&
            std::chrono::steady_clock::now() - start > *options.archive_turn) {
            all.has_next_turn = true;
            wait(fmt::format("an archive: {} taken in so far", open->taken + open->known));
            archives.keep(std::move(*open));
            return all;
        }
    }
    const auto after = stamp_of(path, options.beneath);
    if (!finish_partial && open->reader.is_cut()) return wait("an archive without an end");
    if (!after || *after != before) return wait("changed while it was read");
    FileFacts facts;
    facts.path = path;
    facts.station = station_of_file_name(path);
    facts.size_bytes = before.size_bytes;
    facts.modified_ns = before.modified_ns;
    facts.state = open->reader.is_cut() ? FileState::partial : FileState::complete;
    facts.reason = reason_of(*open);
    all.reason = facts.reason;
    if (Status stored = record(facts); !stored) return Result<IngestOutcome>{pass_on(stored)};
    return all;
}

std::optional<OpenArchive> OpenArchives::take(const fs::path& path, const FileStamp& stamp) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(open_, path, &OpenArchive::path);
    if (found == open_.end()) return std::nullopt;
    std::optional<OpenArchive> archive;
    if (found->stamp == stamp) archive.emplace(std::move(*found));
    open_.erase(found);
    return archive;
}

void OpenArchives::keep(OpenArchive archive) {
    const std::lock_guard lock(mutex_);
    if (open_.size() >= most_open_archives) open_.erase(open_.begin());
    open_.push_back(std::move(archive));
}

}  // namespace stormcellar::pipeline
