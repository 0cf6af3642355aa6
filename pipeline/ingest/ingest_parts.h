// pipeline/ingest/ingest_parts.h -- what an Ingestor consists of.
//
// Inside the pipeline room only. Thread contract: that of Ingestor.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <fmt/ranges.h>

#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/chunk_volumes.h"
#include "pipeline/ingest/ingest.h"
#include "pipeline/ingest/living_files.h"
#include "pipeline/keep/site_grids.h"
#include "pipeline/mosaic/mosaic_keeper.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::pipeline {

// Counts a file in while it is worked on.
class Running {
  public:
    explicit Running(std::atomic<int>& count) : count_(count) { ++count_; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() { --count_; }

  private:
    std::atomic<int>& count_;
};

// When a volume of chunks is gridded: when all of it is there, also when nothing more is to be
// waited for, or now.
enum class Finish { when_it_ends, when_quiet, as_it_is };

// What was met in reading a file, in any of its volumes.
struct Reading {
    bool damaged = false;                    // bytes are lost
    std::vector<std::string> troubles = {};  // of the radar, by its last message 2

    // As grids keep them.
    [[nodiscard]] std::vector<std::string> troubles_of(const std::string& station) const {
        if (troubles.empty()) return {};
        return {fmt::format("{}: {}", station, fmt::join(troubles, ", "))};
    }
};

// An archive whose members are taken in by turns, from one to the next.
struct OpenArchive {
    std::filesystem::path path;
    FileStamp stamp;
    Descriptor file;
    archive::ArchiveReader reader;
    std::size_t taken = 0, rejected = 0;
    std::size_t known = 0;  // to the catalog, from an earlier time
};

// Those that wait for their next turn, a few of them; the others are opened again. Any thread.
class OpenArchives {
  public:
    // None where it is not open, or has changed since.
    [[nodiscard]] std::optional<OpenArchive> take(const std::filesystem::path& path,
                                                  const FileStamp& stamp);
    void keep(OpenArchive archive);

  private:
    std::mutex mutex_;
    std::vector<OpenArchive> open_;  // the one that has waited longest first
};

struct Ingestor::Impl {
    Impl(catalog::CatalogWriter& its_catalog, cache::StoreWriter* its_store,
         IngestOptions its_options);

    catalog::CatalogWriter& catalog;
    cache::StoreWriter* store;  // none: files are only registered
    IngestOptions options;
    MosaicKeeper mosaics;
    std::optional<SiteGrids> site_grids;  // where there is a cache
    // Where volumes are followed as they grow:
    std::optional<LivingFiles> living;
    std::optional<ChunkVolumes> chunks;
    std::atomic<int> running{0};
    OpenArchives archives;

    Result<IngestOutcome> ingest(const std::filesystem::path& path, bool finish_partial);
    // A file that was tried often enough. `why`: of the last try.
    Result<IngestOutcome> give_up(const std::filesystem::path& path, const Error& why);
    // The station itself where its data are taken in, else empty. `admit`: the data are whole, so
    // a new name may be admitted by the rule.
    enum class Admit : bool { no, yes };
    [[nodiscard]] std::string taken_station(const std::string& station,
                                            Admit admit = Admit::no) const;
    // `is_the_same`: that of ingest_again().
    Result<IngestOutcome> read_and_take_in(const std::filesystem::path& path,
                                           const FileStamp& before, bool finish_partial,
                                           IngestOutcome outcome,
                                           const ReadCheck& is_the_same = {});
    // Into the catalog, among those of no known station where the file's is not taken in.
    Status record(catalog::FileFacts facts);
    Status mark_gone(const std::filesystem::path& path);
    Result<IngestOutcome> reject(const catalog::FileFacts& facts, Error why, IngestOutcome outcome);
    Result<IngestOutcome> reject_unread(const std::filesystem::path& path, const Error& why);
    Result<IngestOutcome> take_in(catalog::FileFacts facts, level2::Decoded decoded,
                                  bool finish_partial, IngestOutcome outcome);
    Result<IngestOutcome> grid_all(const catalog::FileFacts& facts,
                                   const std::vector<level2::Volume>& volumes,
                                   const Reading& reading, IngestOutcome outcome);
    Status keep_mosaics(const catalog::FileFacts& facts, const level2::Volume& volume,
                        const Reading& reading, IngestOutcome& outcome);
    // Of a tar or zip archive: each member is taken in as a file, "ARCHIVE!MEMBER". None: it is no
    // archive.
    std::optional<Result<IngestOutcome>> take_archive(const std::filesystem::path& path,
                                                      const FileStamp& before, bool finish_partial,
                                                      const IngestOutcome& outcome);
    std::optional<OpenArchive> open_archive(const std::filesystem::path& path,
                                            const FileStamp& stamp);
    Status take_next(OpenArchive& open, const archive::Member& member, IngestOutcome& all);
    [[nodiscard]] level2::DecodeOptions decode_options_for(const std::string& station);
    Result<IngestOutcome> take_member(const std::filesystem::path& archive, const FileStamp& stamp,
                                      const archive::Member& member);
    Result<IngestOutcome> take_member_again(const MemberName& name, const FileStamp& stamp,
                                            const ReadCheck& is_the_same);
    // Of a file that grows and is not followed: it is looked at again when it ends or is quiet.
    Result<IngestOutcome> wait_unread(catalog::FileFacts facts, IngestOutcome outcome);
    [[nodiscard]] ChunkVolumes::Expected expected_of(const ChunkPath& chunk, Finish finish) const;
    // The same of a chunk whose volume found no place.
    Result<IngestOutcome> wait_for_place(const ChunkPath& chunk, const FileStamp& stamp,
                                         IngestOutcome outcome);
    // None: the file is to be read as a whole.
    std::optional<Result<IngestOutcome>> follow(const std::filesystem::path& path,
                                                const FileStamp& before, bool finish_partial,
                                                IngestOutcome outcome);
    [[nodiscard]] Finish finish_of(bool finish_partial) const;
    // None: the file is to be taken by itself. `is_the_same`: that of ingest_again().
    std::optional<Result<IngestOutcome>> take_chunk(const ChunkPath& chunk, const FileStamp& before,
                                                    Finish finish, IngestOutcome outcome,
                                                    const ReadCheck& is_the_same = {});
    Result<IngestOutcome> show_chunk(const ChunkPath& chunk, const catalog::FileFacts& facts,
                                     ChunkVolume& volume, IngestOutcome outcome);
    // Whether a volume of chunks waits in its name, and not in another's.
    [[nodiscard]] bool is_waited_for(const std::filesystem::path& path);
    // Of a chunk whose file is gone, and whose rows say so. None: nothing waits in its name.
    std::optional<Result<IngestOutcome>> take_gone_chunk(const ChunkPath& chunk, Finish finish,
                                                         IngestOutcome outcome);
    Result<IngestOutcome> finish_chunks(ChunkVolume& volume, const std::string& station,
                                        IngestOutcome outcome, const ReadCheck& is_the_same = {});
    Result<IngestOutcome> show_file(const catalog::FileFacts& file, LivingFile& living_file,
                                    IngestOutcome outcome);
    // False where there is no time for it.
    Result<bool> show_living(const KeptVolume& kept, LivingNews news,
                             const std::string& source_file, std::int64_t modified_ns,
                             IngestOutcome& outcome);
    [[nodiscard]] int share_of(int threads) const { return std::max(1, threads / running.load()); }
};

}  // namespace stormcellar::pipeline
