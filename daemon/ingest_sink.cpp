#include "daemon/ingest_sink.h"

#include <utility>

namespace stormcellar::daemon {

IngestSink::IngestSink(catalog::Catalog catalog, cache::Store store, const Config& config)
    : drop_(config.drop),
      catalog_(std::move(catalog)),
      store_(std::move(store)),
      ingestor_(catalog_, store_, config.ingest) {}

Result<std::unique_ptr<IngestSink>> IngestSink::open(const Config& config) {
    auto catalog = catalog::Catalog::open_for_writing(config.state / "catalog");
    if (!catalog) return pass_on(catalog);
    auto store = cache::Store::open_for_writing(real_file_system(), config.cache, true);
    if (!store) return pass_on(store);
    return std::unique_ptr<IngestSink>(
        new IngestSink(std::move(*catalog), std::move(*store), config));
}

Result<Taken> IngestSink::take(const std::filesystem::path& path, bool finish_partial) {
    Taken taken;
    const FileFound found = look_at(path);
    taken.stamp = found.stamp;
    if (found.standing == Standing::directory || found.standing == Standing::other) {
        taken.ingest.result = pipeline::IngestResult::vanished;  // something else took its name
        return taken;
    }
    Result<pipeline::IngestOutcome> outcome = ingestor_.ingest(path, finish_partial);
    if (!outcome) return pass_on(outcome);
    taken.ingest = std::move(*outcome);
    return taken;
}

}  // namespace stormcellar::daemon
