// daemon/service/ingest_sink.h -- the sink of the real service: stores files in catalog and cache
// through pipeline/ingest/ingest.h.
//
// Threads   Several workers call take() at once, but never for the same path (daemon/queue/sink.h).
#pragma once

#include <atomic>
#include <memory>

#include "daemon/config/config.h"
#include "daemon/config/descriptor_plan.h"
#include "daemon/queue/sink.h"
#include "daemon/queue/tried_files.h"
#include "pipeline/care/mend_cache.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "pipeline/mosaic/site_watch.h"

namespace stormcellar::daemon {

class IngestSink final : public Sink {
  public:
    // Opens STATE/catalog and the cache for writing. Makes them if they are missing.
    static Result<std::unique_ptr<IngestSink>> open(const Config& config);

    Result<Taken> take(const std::filesystem::path& path, bool finish_as_is,
                       pipeline::Tries tries) override;
    [[nodiscard]] std::map<std::filesystem::path, std::chrono::seconds> waits() const override {
        return tried_.waits();
    }
    Result<pipeline::Noted> note(const std::filesystem::path& path) override {
        return ingestor_.note(path);
    }
    void set_load(pipeline::Load load) override { *load_ = load; }
    Result<int> mark_missing(const OnStep& step) override {
        return catalog_.mark_missing(drop_, step);
    }
    Result<int> forget_gone(UtcTime before, const OnStep& step) override {
        return catalog_.forget_gone(before, step);
    }
    Result<std::int64_t> roll_rows(const OnStep& step) override;
    [[nodiscard]] CatalogState catalog_state() override;
    CacheRolled roll_cache(const cache::Budgets& budgets, const OnStep& step) override;
    [[nodiscard]] Status can_store() override;
    std::vector<std::string> take_repairs() override;

    // Returns the catalog for the caretaker, which works beside take().
    [[nodiscard]] catalog::CatalogWriter& catalog() { return catalog_; }
    [[nodiscard]] const cache::StoreReader& store() const { return store_; }
    // Returns the cache for the keeper of partials.
    [[nodiscard]] const cache::StoreWriter& writer() const { return store_; }
    [[nodiscard]] pipeline::MosaicMaker& mosaics() { return ingestor_.mosaics(); }
    [[nodiscard]] const std::shared_ptr<StationRule>& stations() const { return stations_; }
    [[nodiscard]] const std::shared_ptr<pipeline::PartialSources>& partial_sources() const {
        return partial_sources_;
    }
    [[nodiscard]] pipeline::CacheMender& mender() { return mender_; }
    [[nodiscard]] pipeline::SiteWatch& site_watch() { return site_watch_; }

  private:
    IngestSink(catalog::CatalogWriter catalog, cache::RollingStore store, const FixedConfig& config,
               std::shared_ptr<StationRule> stations, const DescriptorPlan& descriptors);

    Result<Taken> give_up(const std::filesystem::path& path, Taken taken);
    [[nodiscard]] pipeline::IngestOptions options_of(const FixedConfig& config) const;

    std::filesystem::path drop_;
    TriedFiles tried_;
    std::shared_ptr<StationRule> stations_;
    std::size_t growing_;  // descriptors for growing volumes (descriptor_plan.h)
    catalog::LeftAlone left_alone_;
    std::shared_ptr<pipeline::PartialSources> partial_sources_;
    std::shared_ptr<std::atomic<pipeline::Load>> load_ =
        std::make_shared<std::atomic<pipeline::Load>>(pipeline::Load::light);
    catalog::CatalogWriter catalog_;
    cache::RollingStore store_;
    pipeline::Ingestor ingestor_;
    pipeline::CacheMender mender_;
    pipeline::SiteWatch site_watch_;
};

}  // namespace stormcellar::daemon
