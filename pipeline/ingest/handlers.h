// pipeline/ingest/handlers.h -- how a file of each kind (pipeline/ingest/file_kind.h) is taken in.
//
// One class a kind, made for one file and used once: take() gives what became of the file.
// Errors are those of Ingestor::ingest(). A handler that finds out by reading that the file is of
// another kind hands it to that kind's handler, with an outcome that begins anew.
// Inside the pipeline room only. Thread contract: an object by one thread; the context and the file
// must outlive it.
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

// As what it is.
[[nodiscard]] Result<IngestOutcome> take(IngestContext& context, const OfferedFile& file,
                                         const FileKind& kind);

// A file that is gone: its rows say so. Where a volume of chunks waits in its name, what was in it
// has been decoded: the volume goes on in its name until it is due, as others that come later may
// still make it whole.
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

// One chunk of a volume: it is added to the volume, which is gridded when it is whole or due.
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

    IngestContext& context_;
    const OfferedFile& file_;
    const ChunkPath& chunk_;
    const FileStamp& stamp_;
    IngestOutcome outcome_;
};

// A file that grows: what has been appended is decoded, and the rest when its volume has ended.
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
    std::string station_;  // whose the file says that it is, where its data are taken in
    IngestOutcome outcome_;
};

// A file that is read from its beginning to its end.
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

// A tar or zip archive: each member is taken in as a file, "ARCHIVE!MEMBER".
class TakeArchive {
  public:
    TakeArchive(IngestContext& context, const OfferedFile& file, OpenArchive open)
        : context_(context), file_(file), open_(std::move(open)) {}
    // The archive at the path, where it stands or opened anew; none: it is no archive.
    [[nodiscard]] static std::optional<OpenArchive> open(IngestContext& context,
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

// One member of an archive that was settled before, once more.
[[nodiscard]] Result<IngestOutcome> take_member_again(IngestContext& context,
                                                      const MemberName& name,
                                                      const FileStamp& archive_stamp,
                                                      const ReadCheck& is_the_same);

}  // namespace stormcellar::pipeline
