#include <utility>

#include "base/beneath.h"
#include "pipeline/drop/drop_names.h"
#include "pipeline/drop/read_whole.h"
#include "pipeline/ingest/handlers.h"
#include "pipeline/ingest/take_volumes.h"

namespace stormcellar::pipeline {

TakeWhole::TakeWhole(IngestContext& context, const OfferedFile& file, const Whole& whole)
    : context_(context),
      file_(file),
      stamp_(whole.stamp),
      facts_(facts_unread(file.path, whole.stamp, station_of_name(file.path))) {}

Result<IngestOutcome> TakeWhole::take() {
    const std::uint64_t most = context_.options.most_file_bytes;
    // The file may have been followed until it became too large.
    if (stamp_.size_bytes > most && context_.living) context_.living->forget(file_.path);
    if (!stamp_.regular)
        return reject({ErrorCode::not_a_file, fmt::format("is {}", kind_of_file(stamp_.kind))});
    // Do not open chunks as archives: no chunk is an archive, and there are thousands of chunks.
    if (!file_.is_the_same && stamp_.size_bytes > 0 && !is_chunk_name(file_.path)) {
        auto archive = TakeArchive::open(context_, file_.path, stamp_);
        // If the file no longer exists, the error appears when it is read.
        const bool is_there = archive || (archive.error().code != ErrorCode::not_found &&
                                          archive.error().code != ErrorCode::not_a_file);
        if (!archive && is_there) return take_unread(archive.error());
        if (archive && *archive) return TakeArchive(context_, file_, std::move(**archive)).take();
    }
    if (stamp_.size_bytes > most) {
        return reject(
            {ErrorCode::unsupported,
             fmt::format("has {} bytes, more than the {} that a raw file may have; it was not read",
                         stamp_.size_bytes, most)});
    }
    return read();
}

Result<IngestOutcome> TakeWhole::wait(std::string reason) {
    outcome_.ending = ended::Incomplete{};
    outcome_.reason = std::move(reason);
    return std::move(outcome_);
}

Result<IngestOutcome> TakeWhole::read() {
    auto read = read_whole(context_.options.beneath, file_.path, stamp_.size_bytes,
                           context_.decode_options_for(facts_.station));
    outcome_.read_s = read.read_s;
    outcome_.decode_s = read.decode_s;
    const auto after = stamp_of(file_.path, context_.options.beneath);
    if (!after || *after != stamp_) return wait("the file changed while it was read");
    if (!read.was_read) return take_unread(read.was_read.error());
    facts_.content_hash = read.content_hash;
    if (file_.is_the_same) {
        const Status same = file_.is_the_same(file_.path, stamp_.size_bytes, read.content_hash);
        if (!same) return pass_on(same);
    }
    if (context_.options.check_read) {
        const Status wanted =
            context_.options.check_read(file_.path, stamp_.size_bytes, read.content_hash);
        if (!wanted) {
            return reject({wanted.error().code, without_path(wanted.error().message, file_.path)});
        }
    }
    if (!read.decoded) return take_undecoded(read.decoded.error());
    const auto partial = file_.may_be_partial() ? MayBePartial::yes : MayBePartial::no;
    return TakeVolumes(context_, std::move(facts_), std::move(outcome_))
        .take(std::move(*read.decoded), partial);
}

// Handles a file that cannot be read, at least not now.
Result<IngestOutcome> TakeWhole::take_unread(const Error& why) {
    // The system is short of something, for example of descriptors, so the file is not to blame.
    if (why.code == ErrorCode::io || is_shortage(why.code)) return tl::unexpected<Error>(why);
    if (why.code == ErrorCode::permission) facts_.modified_ns = catalog::never_read_ns;
    return reject({why.code, without_path(why.message, file_.path)});
}

Result<IngestOutcome> TakeWhole::take_undecoded(const Error& why) {
    if (is_shortage(why.code)) return tl::unexpected<Error>(why);
    const bool may_go_on = why.code == ErrorCode::empty || why.code == ErrorCode::truncated;
    if (may_go_on && !file_.may_be_partial()) return wait(why.message);
    return reject(why);
}

}  // namespace stormcellar::pipeline
