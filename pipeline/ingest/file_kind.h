// pipeline/ingest/file_kind.h -- classifies the files that are ingested.
//
// A path is classified by its name, its stamp, its row in the catalog, and the files that are being
// followed. Only the lengths of records are read from the file. Classification changes nothing. A
// handler that reads a file may find that it is of another kind: a file that has the name of a
// chunk but is no chunk is classified again without its name (kind_by_itself()), and a file that
// cannot be followed is read as a whole.
//   Gone, Forbidden, Settled   nothing need be read
//   Chunk                      one file of many that make a volume
//   Growing                    a volume to which data are appended, decoded as they come
//   Whole                      everything else: a volume, an archive, or a file that will be
//                              rejected
// Inside the pipeline room only. Thread contract: many threads may call the functions, for
// different files.
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

// The time at which to grid a volume: only after it has ended; also if it has not ended but nothing
// more is expected; or now, in any case.
enum class Finish { when_it_ends, when_quiet, as_it_is };

// A file that is offered to the ingestor, and how to treat it.
struct OfferedFile {
    std::filesystem::path path;
    Finish finish = Finish::when_it_ends;
    bool is_again = false;       // was settled before, but must be gridded again
    ReadCheck is_the_same = {};  // the check of Ingestor::ingest_again(); empty: no check

    // Returns true if the file's volume may be gridded even if it has not ended.
    [[nodiscard]] bool may_be_partial() const { return finish != Finish::when_it_ends; }
};

struct Gone {
    std::optional<ChunkPath> chunk;  // set if its name is a chunk's
};
struct Forbidden {  // a directory's permissions do not allow examining the file
    Error why;
};
struct Settled {};
struct Chunk {
    ChunkPath name;
    FileStamp stamp;
};
struct Growing {
    FileStamp stamp;
    std::shared_ptr<FollowedFile> followed;  // null: following begins now
    FollowedFile::Growing start;             // of a file that begins to be followed now
};
struct Whole {
    FileStamp stamp;
};
using FileKind = std::variant<Gone, Forbidden, Settled, Chunk, Growing, Whole>;

// Classifies a file. Errors: those of the catalog, and every failure to examine the file, except
// that a lack of permission gives Forbidden.
[[nodiscard]] Result<FileKind> kind_of(const IngestContext& context, const OfferedFile& file);

// Classifies an existing file as Growing or Whole. Ignores its name.
[[nodiscard]] FileKind kind_by_itself(const IngestContext& context, const OfferedFile& file,
                                      const FileStamp& stamp);

}  // namespace stormcellar::pipeline
