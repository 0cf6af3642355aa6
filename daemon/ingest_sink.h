// daemon/ingest_sink.h -- the real sink: catalog, grids and cache through pipeline/ingest.h.
// Thread contract: that of Sink.
#pragma once

#include <memory>

#include "daemon/config.h"
#include "daemon/sink.h"

namespace stormcellar::daemon {

class IngestSink final : public Sink {
  public:
    // Opens state/catalog and the cache for writing, making them where they are missing.
    static Result<std::unique_ptr<IngestSink>> open(const Config& config);

    Result<Taken> take(const std::filesystem::path& path, bool finish_partial) override;
    Result<int> mark_missing() override { return catalog_.mark_missing(drop_); }

  private:
    IngestSink(catalog::Catalog catalog, cache::Store store, const Config& config);

    std::filesystem::path drop_;
    catalog::Catalog catalog_;
    cache::Store store_;
    pipeline::Ingestor ingestor_;
};

}  // namespace stormcellar::daemon
