// pipeline/ingest/handlers.h -- ingests files of each kind (pipeline/ingest/file_kind.h).
//
// There is one class for each kind. An object is made for one file and used once; take() returns
// the outcome for the file. If a handler finds, by reading, that the file is of another kind, it
// passes the file to the handler of that kind, with a new outcome. Errors are those of
// Ingestor::ingest(). Inside the pipeline room only. Thread contract: one thread uses an object;
// the context and the file must outlive the object.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "pipeline/ingest/file_kind.h"
#include "pipeline/ingest/ingest_context.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/member_name.h"

namespace stormcellar::pipeline {

// Ingests the file with the handler of its kind.
[[nodiscard]] Result<IngestOutcome> take(IngestContext& context, const OfferedFile& file,
                                         const FileKind& kind);

// Marks the rows of a file that is gone. If the file represents a volume in chunks, its data are
// already decoded. The volume is still polled under the file's name until it is due, because later
// chunks may complete it.
class TakeGone {
  public:
    TakeGone(IngestContext& context, const OfferedFile& file) : context_(context), file_(file) {}
    Result<IngestOutcome> take(const Gone& gone);

  private:
    static constexpr std::string_view deleted_text =
        "the chunk that represented the volume was deleted";
    Result<IngestOutcome> finish(const ChunkPath& chunk, const ChunkVolumes::Shared& shared,
                                 ChunkVolume& volume);

    IngestContext& context_;
    const OfferedFile& file_;
};

// Handles a chunk: adds it to its volume, and grids the volume when it is complete or due.
class TakeChunk {
  public:
    TakeChunk(IngestContext& context, const OfferedFile& file, const Chunk& chunk)
        : context_(context), file_(file), chunk_(chunk.name), stamp_(chunk.stamp) {}
    Result<IngestOutcome> take();

  private:
    [[nodiscard]] ChunkVolumes::Expected expected() const;
    Result<IngestOutcome> poll_for_place();
    Result<IngestOutcome> add_to(const ChunkVolumes::Shared& shared,
                                 Guarded<ChunkVolume>::Locked& volume);
    Result<IngestOutcome> finish(const ChunkVolumes::Shared& shared, ChunkVolume& volume,
                                 const std::string& station);
    Result<IngestOutcome> show(const ChunkVolumes::Shared& shared, ChunkVolume& volume,
                               const std::string& station);
    Status record(const ChunkVolume& volume, const std::filesystem::path& path,
                  const std::string& station);

    IngestContext& context_;
    const OfferedFile& file_;
    const ChunkPath& chunk_;
    const FileStamp& stamp_;
    IngestOutcome outcome_;
};

// Handles a growing file. Decodes what was appended, and finishes the volume when it has ended.
class TakeGrowing {
  public:
    TakeGrowing(IngestContext& context, const OfferedFile& file, const Growing& growing);
    Result<IngestOutcome> take();

  private:
    void begin();
    bool read();
    Result<IngestOutcome> show();
    Result<IngestOutcome> finish(std::chrono::steady_clock::time_point start);
    Result<IngestOutcome> take_whole();

    IngestContext& context_;
    const OfferedFile& file_;
    const Growing& growing_;
    std::shared_ptr<FollowedFile> followed_;
    catalog::FileFacts facts_;
    std::string station_;  // the station that the file names, if its data are accepted
    IngestOutcome outcome_;
};

// Handles a file that is read from its beginning to its end.
class TakeWhole {
  public:
    TakeWhole(IngestContext& context, const OfferedFile& file, const Whole& whole);
    Result<IngestOutcome> take();

  private:
    Result<IngestOutcome> reject(Error why) {
        return context_.reject(facts_, std::move(why), std::move(outcome_));
    }
    Result<IngestOutcome> wait(std::string reason);
    Result<IngestOutcome> read();
    Result<IngestOutcome> take_unread(const Error& why);
    Result<IngestOutcome> take_undecoded(const Error& why);

    IngestContext& context_;
    const OfferedFile& file_;
    const FileStamp& stamp_;
    catalog::FileFacts facts_;
    IngestOutcome outcome_;
};

// Handles a tar or zip archive: ingests each member as a file named "ARCHIVE!MEMBER".
class TakeArchive {
  public:
    TakeArchive(IngestContext& context, const OfferedFile& file, OpenArchive open)
        : context_(context), file_(file), open_(std::move(open)) {}
    // Returns the archive at the path, which is open already or is opened now. Returns none if the
    // file is not an archive. Errors: the file cannot be opened.
    [[nodiscard]] static Result<std::optional<OpenArchive>> open(IngestContext& context,
                                                                 const std::filesystem::path& path,
                                                                 const FileStamp& stamp);
    Result<IngestOutcome> take();

  private:
    Result<IngestOutcome> wait(std::string reason);
    Status take_next(const archive::Member& member);
    Result<IngestOutcome> settle();

    IngestContext& context_;
    const OfferedFile& file_;
    OpenArchive open_;
    IngestOutcome outcome_;
};

// Ingests one member of an archive again, even if it was settled before.
[[nodiscard]] Result<IngestOutcome> take_member_again(IngestContext& context,
                                                      const MemberName& name,
                                                      const FileStamp& archive_stamp,
                                                      const ReadCheck& is_the_same);

}  // namespace stormcellar::pipeline
