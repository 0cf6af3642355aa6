#include "pipeline/ingest/ingest.h"

#include <utility>

#include "pipeline/drop/drop_names.h"
#include "pipeline/ingest/handlers.h"
#include "stormcellar/base/member_name.h"

namespace stormcellar::pipeline {

namespace fs = std::filesystem;

struct Ingestor::Impl {
    IngestContext context;

    [[nodiscard]] Finish finish_of(bool finish_as_is) const {
        if (!finish_as_is) return Finish::when_it_ends;
        // Without a scratch directory, the file is not offered again when it has been quiet.
        return context.options.living.scratch.empty() ? Finish::as_it_is : Finish::when_quiet;
    }
    Result<IngestOutcome> ingest(const fs::path& path, bool finish_as_is);
    Result<IngestOutcome> give_up(const fs::path& path, const Error& why);
    [[nodiscard]] bool is_waited_for(const fs::path& path) const;
};

namespace {

struct Taker {
    IngestContext& context;
    const OfferedFile& file;

    Result<IngestOutcome> operator()(const Gone& gone) const {
        return TakeGone(context, file).take(gone);
    }
    Result<IngestOutcome> operator()(const Forbidden& forbidden) const {
        return context.reject_unread(
            file.path, {forbidden.why.code, without_path(forbidden.why.message, file.path)});
    }
    Result<IngestOutcome> operator()(const Settled& /*settled*/) const {
        IngestOutcome outcome;
        outcome.ending = ended::Unchanged{};
        return outcome;
    }
    Result<IngestOutcome> operator()(const Chunk& chunk) const {
        return TakeChunk(context, file, chunk).take();
    }
    Result<IngestOutcome> operator()(const Growing& growing) const {
        return TakeGrowing(context, file, growing).take();
    }
    Result<IngestOutcome> operator()(const Whole& whole) const {
        return TakeWhole(context, file, whole).take();
    }
};

}  // namespace

Result<IngestOutcome> take(IngestContext& context, const OfferedFile& file, const FileKind& kind) {
    return std::visit(Taker{context, file}, kind);
}

Ingestor::Ingestor(catalog::CatalogWriter& catalog, cache::StoreWriter& store,
                   IngestOptions options)
    : impl_(new Impl{{catalog, &store, std::move(options)}}) {}
Ingestor::Ingestor(catalog::CatalogWriter& catalog, IngestOptions options)
    : impl_(new Impl{{catalog, nullptr, std::move(options)}}) {}
Ingestor::~Ingestor() = default;

MosaicMaker& Ingestor::mosaics() {
    return impl_->context.mosaics;
}

Result<IngestOutcome> Ingestor::ingest(const fs::path& path, bool finish_as_is, Tries tries) {
    const Running running(impl_->context);
    auto outcome = impl_->ingest(path, finish_as_is);
    if (outcome || tries == Tries::more_follow || is_shortage(outcome.error().code)) return outcome;
    return impl_->give_up(path, outcome.error());
}

Result<IngestOutcome> Ingestor::Impl::ingest(const fs::path& path, bool finish_as_is) {
    const OfferedFile file{.path = path, .finish = finish_of(finish_as_is)};
    const auto kind = kind_of(context, file);
    if (!kind) return pass_on(kind);
    return take(context, file, *kind);
}

// After a restart the cause may be gone, so the stamp in the row does not settle the file.
Result<IngestOutcome> Ingestor::Impl::give_up(const fs::path& path, const Error& why) {
    const auto stamp = stamp_of(path, context.options.beneath);
    if (context.living) context.living->forget(path);
    auto rejected =
        context.reject_unread(path, {why.code, "given up: " + without_path(why.message, path)},
                              stamp ? stamp->size_bytes : 0);
    // If the rejection cannot be stored, return `why`, not the error of storing.
    return rejected ? std::move(rejected) : Result<IngestOutcome>{tl::unexpected<Error>(why)};
}

Result<IngestOutcome> Ingestor::give_up(const fs::path& path, const Error& why) {
    const Running running(impl_->context);
    return impl_->give_up(path, why);
}

bool Ingestor::Impl::is_waited_for(const fs::path& path) const {
    const auto chunk = ChunkPath::of(path);
    const auto shared = chunk ? context.chunks.find_known(*chunk) : nullptr;
    if (!shared) return false;
    const auto volume = shared->lock();
    return !volume->is_closed() && volume->is_representative(path);
}

Result<Noted> Ingestor::note(const fs::path& path) {
    IngestContext& context = impl_->context;
    const auto stamp = stamp_of(path, context.options.beneath);
    if (!stamp && stamp.error().code == ErrorCode::not_found) {
        if (Status marked = context.mark_gone(path); !marked) return pass_on(marked);
        return impl_->is_waited_for(path) ? Noted::stands : Noted::gone;
    }
    // If this is not a regular file, ingest() will reject it.
    if (!stamp || !stamp->regular) return Noted::stands;
    const Status noted = context.note_seen(facts_unread(path, *stamp, station_of_path(path)));
    if (!noted) return pass_on(noted);
    return Noted::stands;
}

Result<IngestOutcome> Ingestor::ingest_again(const fs::path& path, const ReadCheck& is_the_same) {
    IngestContext& context = impl_->context;
    const Running running(context);
    const auto stamp = stamp_of(path, context.options.beneath);
    if (!stamp && stamp.error().code == ErrorCode::not_found) {
        for (const MemberName& name : member_names_in(path)) {
            const auto archive = stamp_of(name.archive, context.options.beneath);
            if (archive && archive->regular)
                return take_member_again(context, name, *archive, is_the_same);
        }
    }
    if (!stamp) return pass_on(stamp);
    const OfferedFile file{path, Finish::as_it_is, true, is_the_same};
    auto chunk = ChunkPath::of(path);
    if (!chunk) return take(context, file, Whole{*stamp});
    context.chunks.forget(*chunk);
    if (!stamp->regular) return take(context, file, Whole{*stamp});
    return take(context, file, Chunk{std::move(*chunk), *stamp});
}

}  // namespace stormcellar::pipeline
