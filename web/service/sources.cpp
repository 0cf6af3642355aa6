#include "web/service/sources.h"

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include "web/data/grids/kept_answers.h"
#include "web/data/storms/cell_events.h"
#include "web/doors/api/door.h"
#include "web/doors/events/events.h"
#include "web/doors/index/index.h"
#include "web/doors/metrics/metrics.h"
#include "web/doors/overlays/overlays.h"
#include "web/doors/pictures/frames.h"
#include "web/doors/pictures/loops.h"
#include "web/doors/pictures/tiles.h"
#include "web/doors/rainviewer/rainviewer.h"
#include "web/doors/raw/polling.h"
#include "web/doors/raw/volumes.h"
#include "web/doors/s3/s3.h"
#include "web/doors/storms/placefiles.h"
#include "web/doors/thredds/thredds.h"
#include "web/doors/viewer/viewer.h"
#include "web/doors/viewer/viewer_files.h"
#include "web/doors/wms/wms.h"
#include "web/doors/zarr/station_door.h"
#include "web/doors/zarr/zarr.h"

namespace stormcellar::web {
namespace {

// For each frame that may wait, this many maps may wait. A map takes milliseconds and a frame up to
// seconds. So both have their own workers.
constexpr std::size_t maps_for_a_frame = 8;

// Draws the pictures of the data server, with one memory for all pictures.
struct Pictures {
    FramePicturesOptions options;
    std::shared_ptr<RainTotals> rain;
    std::shared_ptr<SweepPictures> sweeps;
    std::shared_ptr<MapPictures> maps;
};
Pictures pictures_of(const Sources& sources) {
    const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    const auto kept = std::make_shared<KeptAnswers>(sources.setup.web.limits.kept_picture_bytes);
    const FramePicturesOptions options{
        .kept = kept, .threads = threads, .cache = sources.setup.cache};
    const auto sweeps = std::make_shared<SweepPictures>(
        std::make_shared<ServedCatalog>(sources.setup.catalog, sources.catalog), options);
    const auto rain = std::make_shared<RainTotals>(RainTotalsOptions{.grids = sources.grids});
    return {options, rain, sweeps,
            std::make_shared<MapPictures>(MapPicturesOptions{.grids = sources.grids,
                                                             .sweeps = sweeps,
                                                             .rain = rain,
                                                             .kept = kept,
                                                             .threads = threads})};
}

void add_pictures(Doors& doors, const Sources& sources, const Pictures& pictures,
                  const std::shared_ptr<StormScans>& scans) {
    const WebLimits& limits = sources.setup.web.limits;
    const auto renders = static_cast<unsigned>(limits.renders);
    const auto waiting = static_cast<std::size_t>(limits.waiting);
    const auto map_workers = std::make_shared<WorkQueue>(renders, waiting * maps_for_a_frame);
    const auto tiles = std::make_shared<TilesDoor>(pictures.maps);
    tiles->set_workers(map_workers);
    doors.add("/tiles", tiles);
    const auto wms = std::make_shared<WmsDoor>(pictures.maps);
    wms->set_workers(map_workers);
    doors.add("/wms", wms);
    const auto rainviewer = std::make_shared<RainViewerDoor>(pictures.maps);
    rainviewer->set_workers(map_workers);
    for (const char* prefix : {"/public", "/api/maps.json", "/v2", "/rainviewer"})
        doors.add(prefix, rainviewer);
    const auto frames = std::make_shared<FramesDoor>(
        sources.grids, std::make_shared<FramePictures>(pictures.options), pictures.sweeps,
        pictures.rain, scans);
    frames->set_workers(std::make_shared<WorkQueue>(renders, waiting));
    doors.add("/frames", frames);
    doors.add("/loops", std::make_shared<LoopsDoor>(sources.setup.loops));
}

// Returns the workers that compute grids and decode volumes.
std::shared_ptr<WorkQueue> long_workers_of(const WebLimits& limits) {
    return std::make_shared<WorkQueue>(static_cast<unsigned>(limits.renders),
                                       static_cast<std::size_t>(limits.waiting));
}

void add_zarr(Doors& doors, const Sources& sources, const std::shared_ptr<KeptAnswers>& kept,
              const std::shared_ptr<MapPictures>& maps,
              const std::shared_ptr<WorkQueue>& long_workers) {
    const ZarrSources shared{sources.grids, kept, sources.numbers, maps};
    doors.add("/zarr", std::make_shared<ZarrDoor>(shared, ZarrVersion::two));
    const auto three = std::make_shared<ZarrDoor>(shared, ZarrVersion::three);
    doors.add("/zarr3", three);
    if (!sources.setup.web.serves(WebPart::volumes)) return;
    const auto trees = std::make_shared<StationTrees>(StationTreesOptions{
        .catalog = sources.setup.catalog, .reader = sources.catalog, .numbers = sources.numbers});
    const auto volumes = std::make_shared<StationDoor>(trees, kept, three);
    volumes->set_long_workers(long_workers);
    doors.add("/zarr3/volumes", volumes);
}

// Number of databases of the catalog that are open at the same time, each with three descriptors.
// There are some 200 radars, and a list of all stations reads the database of each.
constexpr std::size_t most_databases = 256;

// Follows what the daemon does, for events, metrics and silent stations.
struct Watched {
    std::shared_ptr<EventHub> hub = EventHub::make();
    std::shared_ptr<const EventFeed> feed;
};
Watched watch_over(const Sources& sources, const std::shared_ptr<StormScans>& scans) {
    Watched watched;
    std::function<void(const std::string&)> on_reflectivity;
    if (sources.setup.web.serves(WebPart::events) && sources.setup.web.serves(WebPart::grids)) {
        on_reflectivity = [cells = std::make_shared<CellEvents>(scans, watched.hub)](
                              const std::string& area) { cells->hear(area); };
    }
    watched.feed = EventFeed::open({.grids = sources.grids,
                                    .catalog = sources.setup.catalog,
                                    .reader = sources.catalog,
                                    .hub = watched.hub,
                                    .on_reflectivity = std::move(on_reflectivity),
                                    .silent_after = sources.setup.web.silent});
    return watched;
}

void add_events(Doors& doors, const Watched& watched, const WebLimits& limits) {
    doors.add("/api/v1/events",
              std::make_shared<EventsDoor>(EventsOptions{
                  .hub = watched.hub,
                  .feed = watched.feed,
                  .most_streams = static_cast<std::size_t>(limits.event_streams),
                  .most_of_client = static_cast<std::size_t>(limits.event_streams_of_a_client)}));
}

}  // namespace

Result<Sources> open_sources(WebSetup setup) {
    Sources sources;
    if (!setup.catalog.empty()) {
        auto catalog = catalog::CatalogReader::open(setup.catalog, most_databases);
        if (catalog) {
            sources.catalog = std::make_shared<const catalog::CatalogReader>(std::move(*catalog));
        } else if (catalog.error().code != ErrorCode::not_found) {
            return pass_on(catalog);
        }
    }
    auto grids = Grids::open(
        {.cache = setup.cache, .most_open = static_cast<std::size_t>(setup.web.limits.open_grids)});
    if (!grids) return pass_on(grids);
    sources.grids = std::move(*grids);
    sources.numbers = std::make_shared<TimeNumbers>(setup.numbers);
    sources.setup = std::move(setup);
    return sources;
}

std::shared_ptr<const Doors> doors_to(const Sources& sources, Measures& measures) {
    const WebSetup& setup = sources.setup;
    const WebLimits& limits = setup.web.limits;
    auto doors = std::make_shared<Doors>();
    const auto files = RawFiles::open_catalog({.catalog = setup.catalog,
                                               .reader = sources.catalog,
                                               .grids = sources.grids,
                                               .scratch = {}});
    if (setup.web.serves(WebPart::volumes))
        doors->add("/volumes", std::make_shared<VolumesDoor>(files));
    if (setup.web.serves(WebPart::polling))
        doors->add("/nexrd2", std::make_shared<PollingDoor>(files));
    if (setup.web.serves(WebPart::thredds))
        doors->add(
            "/thredds",
            std::make_shared<ThreddsDoor>(
                files, ThreddsOptions{.config = setup.web.thredds,
                                      .most_results = static_cast<std::size_t>(limits.results)}));
    if (setup.web.serves(WebPart::s3))
        doors->add("/s3", std::make_shared<S3Door>(files, setup.web.bucket));
    const auto kept = std::make_shared<KeptAnswers>(limits.kept_bytes);
    const auto scans = std::make_shared<StormScans>(sources.grids, setup.web.freezing);
    const Watched watched = watch_over(sources, scans);
    const Pictures pictures = pictures_of(sources);
    const auto long_workers = long_workers_of(limits);
    if (setup.web.serves(WebPart::zarr))
        add_zarr(*doors, sources, kept, pictures.maps, long_workers);
    if (setup.web.serves(WebPart::grids)) {
        const auto storms = std::make_shared<const StormAnswers>(scans, kept);
        const auto api = std::make_shared<ApiDoor>(
            ApiSources{.grids = sources.grids,
                       .catalog = setup.catalog,
                       .reader = sources.catalog,
                       .kept = kept,
                       .feed = watched.feed,
                       .gives_volumes = setup.web.serves(WebPart::volumes),
                       .storms = storms});
        api->set_long_workers(long_workers);
        const auto placefiles = std::make_shared<PlacefilesDoor>(storms);
        placefiles->set_long_workers(long_workers);
        doors->add("/placefiles", placefiles);
        doors->add("/api/v1", api);
    }
    if (setup.web.serves(WebPart::events)) add_events(*doors, watched, limits);
    if (setup.web.serves(WebPart::metrics))
        doors->add("/metrics", std::make_shared<MetricsDoor>(measures.counters()));
    if (setup.web.serves(WebPart::pictures)) {
        add_pictures(*doors, sources, pictures, scans);
        doors->add("/overlays", std::make_shared<OverlaysDoor>(setup.web.overlays));
    }
    // The page of the viewer draws data of the API.
    if (setup.web.serves(WebPart::grids) && !viewer_files().empty())
        doors->add("/view", std::make_shared<ViewerDoor>());
    doors->add("/", std::make_shared<IndexDoor>(doors->prefixes(), setup.web.bucket));
    measures.watch_grids(sources.grids);
    measures.watch_events(watched.hub, watched.feed);
    measures.count_doors(*doors);
    return doors;
}

}  // namespace stormcellar::web
