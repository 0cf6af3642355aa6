// pipeline/ingest/file_kind.h -- as what a file is taken in.
//
// A path is classified once, from its name, its stamp, the catalog and what is remembered of files
// that grow; of the contents at most the lengths of records are read. Nothing is changed by it.
// What a handler reads may still show otherwise: a file that is named as a chunk and is none is
// classified again without its name (kind_by_itself()), and a file that cannot be followed is
// taken as a whole.
//   Gone, Forbidden, Settled   there is nothing to read
//   Chunk                      one file of many that make a volume
//   Growing                    a volume that is appended to, and decoded as it comes
//   Whole                      everything else: a volume, an archive, or what is to be rejected
// Inside the pipeline room only. Thread contract: functions, for different files by many threads.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <variant>

#include "pipeline/drop/chunk_path.h"
#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/followed_file.h"
#include "pipeline/ingest/ingest_context.h"
#include "pipeline/options/ingest_options.h"
#include "stormcellar/base/result.h"

namespace stormcellar::pipeline {

// When a volume is gridded that may not be whole: when all of it is there, also when nothing more
// is to be waited for, or now.
enum class Finish { when_it_ends, when_quiet, as_it_is };

// A file that is offered, and how.
struct OfferedFile {
    std::filesystem::path path;
    Finish finish = Finish::when_it_ends;
    bool is_again = false;       // it was settled before, and is to be gridded once more
    ReadCheck is_the_same = {};  // that of Ingestor::ingest_again(); empty: it is not asked

    // The file may be taken in although its volume has not ended.
    [[nodiscard]] bool may_be_partial() const { return finish != Finish::when_it_ends; }
};

struct Gone {
    std::optional<ChunkPath> chunk;  // where it was named as one
};
struct Forbidden {  // it may not even be looked at: its directory has no permission
    Error why;
};
struct Settled {};
struct Chunk {
    ChunkPath name;
    FileStamp stamp;
};
struct Growing {
    FileStamp stamp;
    std::shared_ptr<FollowedFile> followed;  // null: it begins with this look
    FollowedFile::Growing start;             // of one that begins
};
struct Whole {
    FileStamp stamp;
};
using FileKind = std::variant<Gone, Forbidden, Settled, Chunk, Growing, Whole>;

// Errors: the catalog's, and what keeps the file from being looked at, but for its permission.
[[nodiscard]] Result<FileKind> kind_of(const IngestContext& context, const OfferedFile& file);

// As what a file that is there is taken when its name is none of a chunk: Growing or Whole.
[[nodiscard]] FileKind kind_by_itself(const IngestContext& context, const OfferedFile& file,
                                      const FileStamp& stamp);

}  // namespace stormcellar::pipeline
