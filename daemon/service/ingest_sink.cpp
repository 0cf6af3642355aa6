#include "daemon/service/ingest_sink.h"

#include <utility>

#include "daemon/config/station_config.h"
#include "daemon/process/readiness.h"

namespace stormcellar::daemon {
namespace {

// Returns true if the cache must keep the newest grid of the group. The cache need not keep grids
// of stations that the rule "any" accepted, because such stations may not be real.
bool is_known_group(std::string_view group, const StationRule& stations) {
    if (cache::is_known_group(group)) return true;
    return stations.kind() == StationRule::Kind::listed && stations.knows(group);
}

class Trying {
  public:
    Trying(TriedFiles& tried, const std::filesystem::path& path, const FileStamp& stamp)
        : tried_(tried), path_(path) {
        tried_.begin(path_, stamp);
    }
    Trying(const Trying&) = delete;
    Trying& operator=(const Trying&) = delete;
    ~Trying() { tried_.end(path_); }

  private:
    TriedFiles& tried_;
    const std::filesystem::path& path_;
};

}  // namespace

IngestSink::IngestSink(catalog::CatalogWriter catalog, cache::RollingStore store,
                       const FixedConfig& config, std::shared_ptr<StationRule> stations,
                       const DescriptorPlan& descriptors)
    : drop_(config.paths.drop),
      tried_(config.paths.state / "tried"),
      stations_(std::move(stations)),
      growing_(descriptors.growing),
      partial_sources_(std::make_shared<pipeline::PartialSources>(config.partials.late_after)),
      catalog_(std::move(catalog)),
      store_(std::move(store)),
      ingestor_(catalog_, store_, options_of(config)),
      mender_(catalog_, store_, ingestor_, config.grid.moments),
      site_watch_(store_, config.grid.domains) {
    if (auto left = catalog_.left_alone()) left_alone_ = std::move(*left);
}

pipeline::IngestOptions IngestSink::options_of(const FixedConfig& config) const {
    pipeline::IngestOptions options;
    options.moments = config.grid.moments;
    options.derived.dealiasing = config.grid.dealiasing;
    options.derived.quality = config.grid.quality;
    options.spacing_m = config.grid.spacing_m;
    options.nx = config.grid.nx;
    options.ny = config.grid.ny;
    options.levels_m = config.grid.levels_m;
    options.domains = config.grid.domains;
    options.partial_sources = partial_sources_;
    options.decode_threads = config.grid.threads;
    options.grid_threads = config.grid.threads;
    options.stations = stations_;
    options.beneath = config.paths.drop;
    options.living.scratch = config.paths.state;
    options.living.make = config.ingest.living;
    options.living.chunk_timeout = config.ingest.chunk_timeout;
    options.living.chunk_grace = config.ingest.chunk_grace;
    options.living.count = growing_;
    // A turn is much shorter than the time after which the watchdog assumes that a step hangs.
    options.archive_turn = std::chrono::seconds{20};
    options.living.load = [load = load_] { return load->load(); };
    return options;
}

Result<std::unique_ptr<IngestSink>> IngestSink::open(const Config& config) {
    const FixedConfig& fixed = config.fixed;
    const DescriptorPlan descriptors = DescriptorPlan::of_this_process();
    auto stations = std::make_shared<StationRule>(fixed.ingest.stations);
    catalog::CatalogOptions options;
    options.stations = stations;
    options.most_open = descriptors.databases;
    options.drop = fixed.paths.drop;
    options.most_bytes = fixed.storage.catalog_bytes.value_or(catalog::CatalogOptions::no_limit);
    auto catalog = catalog::CatalogWriter::open(fixed.paths.state / "catalog", options);
    if (!catalog) return pass_on(catalog);
    cache::Surroundings surroundings;
    surroundings.is_known = [stations](std::string_view group) {
        return is_known_group(group, *stations);
    };
    auto store = cache::RollingStore::open(real_file_system(), fixed.paths.cache,
                                           config.reloadable.budgets, std::move(surroundings));
    if (!store) return pass_on(store);
    store->pack_with(fixed.storage.packing);
    return std::unique_ptr<IngestSink>(new IngestSink(std::move(*catalog), std::move(*store), fixed,
                                                      std::move(stations), descriptors));
}

Result<std::int64_t> IngestSink::roll_rows(const OnStep& step) {
    const auto rolled = catalog_.roll(step);
    if (!rolled) return pass_on(rolled);
    return rolled->rows;
}

CatalogState IngestSink::catalog_state() {
    CatalogState state;
    for (const catalog::Trouble& trouble : catalog_.troubles())
        state.troubles.emplace_back(trouble.station, trouble.error.message);
    state.rule = name_of(stations_->kind());
    state.further = stations_->further();
    state.most_further = stations_->most_further();
    state.left_alone = left_alone_.count;
    state.some_left_alone = left_alone_.some;
    return state;
}

CacheRolled IngestSink::roll_cache(const cache::Budgets& budgets, const OnStep& step) {
    store_.set_budgets(budgets);
    CacheRolled rolled{store_.roll(step), {}};
    rolled.usage = store_.usage();
    return rolled;
}

Status IngestSink::can_store() {
    for (const std::filesystem::path& directory : {catalog_.directory(), store_.directory()}) {
        if (Status written = can_write_in(real_file_system(), directory); !written) return written;
    }
    return {};
}

std::vector<std::string> IngestSink::take_repairs() {
    std::vector<std::string> lines;
    for (const catalog::Repair& repair : catalog_.take_repairs())
        lines.push_back(catalog::describe(repair));
    return lines;
}

Result<Taken> IngestSink::give_up(const std::filesystem::path& path, Taken taken) {
    auto outcome = ingestor_.give_up(
        path, {ErrorCode::unsupported,
               fmt::format("the service ended {} times while it read it", TriedFiles::most_ends)});
    if (!outcome) return pass_on(outcome);
    taken.ingest = std::move(*outcome);
    return taken;
}

Result<Taken> IngestSink::take(const std::filesystem::path& path, bool finish_as_is,
                               pipeline::Tries tries) {
    Taken taken;
    const FileFound found = look_at(path, drop_);
    taken.stamp = found.stamp;
    if (found.standing == Standing::directory || found.standing == Standing::other) {
        // Another file has this name now.
        taken.ingest.ending = pipeline::ended::Vanished{};
        return taken;
    }
    if (tried_.is_given_up(path, found.stamp)) return give_up(path, std::move(taken));
    const Trying trying(tried_, path, found.stamp);
    Result<pipeline::IngestOutcome> outcome = ingestor_.ingest(path, finish_as_is, tries);
    if (!outcome) return pass_on(outcome);
    taken.ingest = std::move(*outcome);
    return taken;
}

}  // namespace stormcellar::daemon
