// daemon/sink.h -- what the service does with a file: one call, so that the service can be tested
// without radar data.
// Thread contract: take() is called by several workers at once, never twice at a time for one path.
#pragma once

#include <filesystem>

#include "base/result.h"
#include "daemon/file_stamp.h"
#include "pipeline/ingest.h"

namespace stormcellar::daemon {

struct Taken {
    FileStamp stamp;  // of the file before it was read
    pipeline::IngestOutcome ingest;
};

class Sink {
  public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    virtual ~Sink() = default;

    // An error is ours alone (catalog or cache cannot be written): the file is tried again later.
    virtual Result<Taken> take(const std::filesystem::path& path, bool finish_partial) = 0;
    // Marks what is known and no longer there, as after a scan; gives how much. May run beside
    // take().
    virtual Result<int> mark_missing() = 0;
};

}  // namespace stormcellar::daemon
