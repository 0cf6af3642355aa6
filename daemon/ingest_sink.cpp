#include "daemon/ingest_sink.h"

#include <utility>

namespace stormcellar::daemon {

IngestSink::IngestSink(catalog::Catalog catalog, cache::Store store, const Config& config,
                       std::shared_ptr<StationRule> stations)
    : drop_(config.drop),
      stations_(std::move(stations)),
      catalog_(std::move(catalog)),
      store_(std::move(store)),
      ingestor_(catalog_, store_, options_of(config)),
      mender_(catalog_, store_, ingestor_, config.ingest.moment),
      site_watch_(store_, config.ingest.domains) {}

pipeline::IngestOptions IngestSink::options_of(const Config& config) const {
    pipeline::IngestOptions options = config.ingest;
    options.stations = stations_;
    options.beneath = config.drop;
    options.living.scratch = config.state;
    options.living.make = config.living;
    options.living.has_time = [pressed = pressed_] { return !*pressed; };
    return options;
}

Result<std::unique_ptr<IngestSink>> IngestSink::open(const Config& config) {
    auto stations = std::make_shared<StationRule>(config.stations);
    auto catalog = catalog::Catalog::open_for_writing(config.state / "catalog");
    if (!catalog) return pass_on(catalog);
    auto store = cache::Store::open_rolling(real_file_system(), config.cache, config.budgets);
    if (!store) return pass_on(store);
    store->pack_with(config.packing);
    return std::unique_ptr<IngestSink>(
        new IngestSink(std::move(*catalog), std::move(*store), config, std::move(stations)));
}

CacheRolled IngestSink::roll_cache(const cache::Budgets& budgets, const OnStep& step) {
    store_.set_budgets(budgets);
    CacheRolled rolled{store_.roll(step), {}};
    rolled.usage = store_.usage();
    return rolled;
}

std::vector<std::string> IngestSink::take_repairs() {
    std::vector<std::string> lines;
    for (const catalog::Repair& repair : catalog_.take_repairs())
        lines.push_back(catalog::describe(repair));
    return lines;
}

Result<Taken> IngestSink::take(const std::filesystem::path& path, bool finish_partial,
                               pipeline::Tries tries) {
    Taken taken;
    const FileFound found = look_at(path, drop_);
    taken.stamp = found.stamp;
    if (found.standing == Standing::directory || found.standing == Standing::other) {
        taken.ingest.result = pipeline::IngestResult::vanished;  // something else took its name
        return taken;
    }
    Result<pipeline::IngestOutcome> outcome = ingestor_.ingest(path, finish_partial, tries);
    if (!outcome) return pass_on(outcome);
    taken.ingest = std::move(*outcome);
    return taken;
}

}  // namespace stormcellar::daemon
