// pipeline/ingest/open_archives.h -- the archives whose members are ingested a few at a time, in
// turns.
//
// Inside the pipeline room only. Thread contract: any thread may use OpenArchives; one thread may
// use an OpenArchive.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "base/steady_time.h"
#include "pipeline/drop/file_facts.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::pipeline {

// An archive whose members are ingested one after the other, and the progress of this work.
struct OpenArchive {
    std::filesystem::path path;
    FileStamp stamp;
    Descriptor file;
    archive::ArchiveReader reader;
    std::size_t taken = 0, rejected = 0;
    std::size_t known = 0;                     // number of members that the catalog already knew
    std::set<std::filesystem::path> met = {};  // paths of the members that were taken so far
};

// The archives that wait for their next turn. The first four stay open until they end, are deleted,
// or have waited for a day. Every other archive is opened again for its next turn and read from its
// beginning. So some archives always make progress.
class OpenArchives {
  public:
    // Takes the archive out of the list. Returns none if the archive is not open, or has changed
    // since.
    [[nodiscard]] std::optional<OpenArchive> take(const std::filesystem::path& path,
                                                  const FileStamp& stamp);
    void keep(OpenArchive archive);

  private:
    static constexpr std::size_t most_open = 4;
    static constexpr std::chrono::hours longest_wait{24};  // an archive that waits longer is closed

    struct Waiting {
        OpenArchive archive;
        SteadyTime since;
    };

    Mutex mutex_;
    std::vector<Waiting> open_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pipeline
