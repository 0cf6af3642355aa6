#include "pipeline/ingest/file_kind.h"

#include <utility>

namespace stormcellar::pipeline {

FileKind kind_by_itself(const IngestContext& context, const OfferedFile& file,
                        const FileStamp& stamp) {
    const bool may_be_followed = context.living && stamp.regular && !file.is_again &&
                                 stamp.size_bytes <= context.options.most_file_bytes;
    if (!may_be_followed) return Whole{stamp};
    if (auto followed = context.living->find(file.path))
        return Growing{stamp, std::move(followed), {}};
    // Do not begin to follow a file that may be gridded before its volume ends, such as a quiet
    // file.
    if (file.may_be_partial()) return Whole{stamp};
    if (auto start = FollowedFile::growing(file.path, context.options.beneath))
        return Growing{stamp, nullptr, std::move(*start)};
    return Whole{stamp};
}

Result<FileKind> kind_of(const IngestContext& context, const OfferedFile& file) {
    const auto stamp = stamp_of(file.path, context.options.beneath);
    if (!stamp) {
        const ErrorCode code = stamp.error().code;
        if (code == ErrorCode::permission) return Forbidden{stamp.error()};
        if (code == ErrorCode::not_found) return Gone{ChunkPath::of(file.path)};
        return pass_on(stamp);
    }
    const auto settled =
        context.catalog.is_settled(file.path, stamp->size_bytes, stamp->modified_ns);
    if (!settled) return pass_on(settled);
    if (*settled) return Settled{};
    const bool may_be_chunk =
        stamp->regular && stamp->size_bytes <= context.options.most_file_bytes;
    if (auto chunk = may_be_chunk ? ChunkPath::of(file.path) : std::nullopt)
        return Chunk{std::move(*chunk), *stamp};
    return kind_by_itself(context, file, *stamp);
}

}  // namespace stormcellar::pipeline
