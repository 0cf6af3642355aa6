#include "cli/reference/command_guide.h"

#include <algorithm>
#include <iterator>

namespace stormcellar::cli {
namespace {

using Guides = std::vector<CommandGuide>;

Guides guides_of_use() {
    return {
        {"",
         {{"stormcellar info KTLX19990503_235621.gz", "Describe a file."},
          {"stormcellar frame KTLX19990503_235621.gz -o storm.png", "Draw the storm."},
          {"stormcellar frame KTLX --cache CACHE -o now.png",
           "Draw the newest storm that the daemon gridded."},
          {"stormcellar loop KTLX --cache CACHE --from -1h -o storm.webp",
           "Draw its last hour as a loop."},
          {"stormcellar help frame", "Show what a command can do."}}},
        {"help", {{"stormcellar help catalog get", "Show the help of one command."}}},
        {"serve",
         {{"stormcellar serve KTLX19990503_235621.gz",
           "Serve a volume and its grids to a browser, Siphon, xarray or a GIS."},
          {"stormcellar serve --cache CACHE --catalog STATE/catalog",
           "Serve the data of a daemon on another port than its own server."},
          {"stormcellar serve files/ --listen 192.168.1.5:8090 --allow-host radar-pc",
           "Serve files to the machines of this network."}}},
        {"view",
         {{"stormcellar view KTLX19990503_235621.gz", "Turn a storm and fly through it."},
          {"stormcellar view files/ --no-browser",
           "Show many volumes; print the address without opening a browser."}}},
        {"status",
         {{"stormcellar status", "Show the status of the daemon on this machine."},
          {"stormcellar status --config stormcellard.toml", "Show the status of another daemon."}}},
    };
}

Guides guides_of_files() {
    return {
        {"cells",
         {{"stormcellar cells KTLX19990503_*.gz",
           "Print the storm cells of the newest volume, with their motion and history."},
          {"stormcellar cells KTLX19990503_*.gz --shear -o cells.geojson",
           "Write cells, tracks and forecasts for GIS, with the rotation of each cell."},
          {"stormcellar cells CACHE/oklahoma/REF/19990503/*.scg --to placefile",
           "Print a placefile of the cells in the grids of a domain."}},
         {"--output", "--to", "--json", "--shear", "--freezing-levels", "--quality"}},
        {"cyclone",
         {{"stormcellar cyclone KCRP20170826_044114_V06",
           "Print a hurricane's center, wind by radius and fall of pressure."},
          {"stormcellar cyclone KCRP20170826_044114_V06 --near 28.1,-97.0 --mean-wind=-2,2.5",
           "Start from a known center, and correct for the wind that carries the hurricane."}}},
        {"fetch",
         {{"stormcellar fetch --stations KTLX --from 1999-05-03T23:00:00Z --to "
           "1999-05-03T23:59:00Z -o files",
           "Fetch the volumes of an hour of one radar."}}},
        {"info",
         {{"stormcellar info KTLX19990503_235621.gz", "List the sweeps, moments and times."},
          {"stormcellar info KTLX19990503_235621.gz --echo",
           "Also say which share of the echo is weather, ground or birds."},
          {"stormcellar info KTLX19990503_235621.gz --to volume.nc",
           "Also write the volume as CfRadial."},
          {"stormcellar info KTLX19990503_235621.gz --to volume.h5",
           "Also write the volume as ODIM_H5."}},
         {"--json", "--echo", "--to", "--volume", "--format", "--dealias", "--moment",
          "--station"}},
        {"profile",
         {{"stormcellar profile KTLX19990503_235621.gz --plot hodograph.png",
           "Print the wind by height and the motion of storms, and draw a hodograph."},
          {"stormcellar profile files/ --plot winds.png --units knots,kft",
           "Draw the volumes of one radar by time and height."}},
         {"--plot", "--units", "--json", "--layer-m", "--reach-km"}},
        {"replay",
         {{"stormcellar replay files/ DROP --speed 10",
           "Play a directory of volumes ten times as fast as they came."}}},
        {"synth",
         {{"stormcellar synth supercell.toml -o files",
           "Write the volumes of a simulated storm."}}},
    };
}

Guides guides_of_batch() {
    return {
        {"batch check",
         {{"stormcellar batch check --plan PLAN --table",
           "Show the progress, and the volumes of each station and hour."}}},
        {"batch merge",
         {{"stormcellar batch merge --plan PLAN --task 160", "Make the frames of one hour."}}},
        {"batch plan",
         {{"stormcellar batch plan --source files/ --from 1999-05-03 --to 1999-05-04 -o PLAN",
           "Plan own grids of all stations for two days."},
          {"stormcellar batch plan --source files/ --from 1999-05-03T20:00 --to 1999-05-04T02:00 "
           "--mosaic oklahoma --bounds=-100,33.5,-95,37 -o PLAN",
           "Plan a mosaic every five minutes."},
          {"stormcellar batch plan --source https://unidata-nexrad-level2.s3.amazonaws.com "
           "--stations KTLX,KFDR --from 1999-05-03 --to 1999-05-04 -o PLAN",
           "Let each task fetch its raw files from the public bucket."}},
         {"--source", "--from", "--to", "--stations", "--bounds", "--output", "--cache", "--moment",
          "--mosaic", "--spacing-km"}},
        {"batch run",
         {{"stormcellar batch run --plan PLAN --task 12", "Grid one day of one station."},
          {"stormcellar batch run --plan PLAN --task 12-19", "Grid eight of them."}}},
        {"batch statistics",
         {{"stormcellar batch statistics --plan PLAN --by hour -o climatology.nc",
           "Count where it rained how often, by hour of the day."}}},
        {"batch submit",
         {{"stormcellar batch submit --plan PLAN --engine local", "Run the tasks on this machine."},
          {"stormcellar batch submit --plan PLAN --engine slurm --dry-run",
           "Print what Slurm would be told."}}},
    };
}

Guides guides_of_cache() {
    return {
        {"cache evict",
         {{"stormcellar cache evict --cache CACHE --bytes '20 GB' --dry-run",
           "Print which grids would go to keep 20 GB."},
          {"stormcellar cache evict --cache CACHE --older-than 48",
           "Remove the grids of more than two days ago."}}},
        {"cache list",
         {{"stormcellar cache list --cache CACHE --domain KTLX --from -1h",
           "List the grids of the last hour."}}},
        {"cache pin",
         {{"stormcellar cache pin --cache CACHE --domain KTLX --from -1h",
           "Keep the grids of the last hour until they are unpinned."}}},
        {"cache stat",
         {{"stormcellar cache stat --cache CACHE",
           "Show the number and the size of each domain's grids."}}},
        {"cache unpin",
         {{"stormcellar cache unpin --cache CACHE --domain KTLX",
           "Let these grids be removed again."}}},
        {"cache verify",
         {{"stormcellar cache verify --cache CACHE", "Read and verify every grid."}}},
    };
}

Guides guides_of_catalog() {
    return {
        {"catalog check",
         {{"stormcellar catalog check --catalog STATE/catalog",
           "Compare the catalog with the files."}}},
        {"catalog get",
         {{"stormcellar catalog get --catalog STATE/catalog --station KTLX --from -1h -o files",
           "Copy the raw files of the last hour."}}},
        {"catalog latest",
         {{"stormcellar catalog latest --catalog STATE/catalog --station KTLX",
           "Show when the newest volume began."}}},
        {"catalog list",
         {{"stormcellar catalog list --catalog STATE/catalog --station KTLX --from -1h",
           "List the volumes of the last hour."}}},
        {"catalog oldest",
         {{"stormcellar catalog oldest --catalog STATE/catalog --station KTLX",
           "Show when the oldest volume began."}}},
        {"catalog rebuild",
         {{"stormcellar catalog rebuild --catalog STATE/catalog --drop DROP",
           "Register all files anew if a database is damaged."}}},
        {"catalog stations",
         {{"stormcellar catalog stations --catalog STATE/catalog",
           "List the stations that have files."}}},
    };
}

Guides guides_of_grids() {
    return {
        {"accuracy",
         {{"stormcellar accuracy KTLX19990503_235621.gz",
           "Measure the cost and the gain of each more accurate way to grid a volume."},
          {"stormcellar accuracy KTLX19990503_235621.gz --plot ladder.svg", "Also plot them."},
          {"stormcellar accuracy --picture KTLX19990503_235621.gz",
           "Measure the cost of a more accurate picture."},
          {"stormcellar accuracy --velocity KTLX19990503_235621.gz",
           "Measure how well each rung dealiases velocities."},
          {"stormcellar accuracy --compare-sites KTLX.gz KFDR.gz",
           "Compare two radars where both see the same air."}},
         {"--moment", "--plot", "--picture", "--velocity", "--held-out", "--compare-sites",
          "--scene", "--time", "--extent-km", "--spacing-km"}},
        {"grid",
         {{"stormcellar grid KTLX19990503_235621.gz -o storm.nc",
           "Write a volume as a 3D grid in netCDF."},
          {"stormcellar grid KTLX19990503_235621.gz -o storm.nc --tolerance '250 m, 3 dB' "
           "--explain",
           "Grid as cheaply as these errors allow, and explain how."},
          {"stormcellar grid KTLX.gz KFDR.gz -o both.nc --time 1999-05-03T23:55:00Z",
           "Write a mosaic of two radars at one instant."}},
         {"--output", "--moment", "--center", "--extent-km", "--spacing-km", "--levels-km",
          "--time", "--method", "--tolerance", "--explain"}},
    };
}

Guides guides_of_pictures() {
    return {
        {"frame",
         {{"stormcellar frame KTLX19990503_235621.gz -o storm.png",
           "Draw a file as a volume; the view fits the storms."},
          {"stormcellar frame KTLX19990503_235621.gz --product composite -o map.png",
           "Draw the greatest value of each column as a map."},
          {"stormcellar frame KTLX --cache CACHE -o now.png",
           "Draw the newest grid that a daemon has made of a station."},
          {"stormcellar frame KTLX --cache CACHE --product section "
           "--section 35.2,-98.2,35.5,-97 -o cut.png",
           "Draw a vertical cut between two places."},
          {"stormcellar frame KTLX19990503_235621.gz --product ppi --moment VEL --elevation 0.5 "
           "-o tilt.png",
           "Draw the velocity of the lowest sweep, gate by gate."},
          {"stormcellar frame KTLX --cache CACHE --product composite --overlay cells -o cells.png",
           "Mark the storm cells of the last hour with tracks and forecasts."},
          {"stormcellar frame KTLX --cache CACHE --probe-at 35.33,-97.5",
           "Print the value at a place."}},
         {"--output", "--cache", "--time", "--product", "--moment", "--colors", "--scene",
          "--azimuth", "--tilt", "--zoom"}},
        {"loop",
         {{"stormcellar loop KTLX --cache CACHE --from -1h -o storm.webp",
           "Draw the last hour of a station."},
          {"stormcellar loop KTLX --cache CACHE --last 12 --product composite -o map.mp4",
           "Draw the last twelve grids as a map."},
          {"stormcellar loop KTLX --catalog STATE/catalog --from 1999-05-03T23:00:00Z --to "
           "1999-05-03T23:59:00Z -o tornado.webp",
           "Grid and draw an hour of an archive."},
          {"stormcellar loop KTLX19990503_235621.gz --product ppi --all-elevations -o up.webp",
           "Show all sweeps of a volume, from the lowest up."}},
         {"--output", "--cache", "--from", "--to", "--last", "--product", "--moment", "--orbit",
          "--fps", "--follow"}},
        {"nowcast",
         {{"stormcellar nowcast KBGM20050822_*.gz",
           "Measure how well echo is extrapolated, by lead time."},
          {"stormcellar nowcast KTLX --cache CACHE --minutes 15,30,60 --product composite -o "
           "soon.png",
           "Draw a radar's echo 15, 30 and 60 minutes ahead, each with its measured error."}},
         {"--minutes", "--output", "--cache", "--domain", "--product", "--json"}},
    };
}

Guides all_guides() {
    Guides all;
    for (const auto group : {guides_of_use, guides_of_files, guides_of_batch, guides_of_cache,
                             guides_of_catalog, guides_of_grids, guides_of_pictures})
        std::ranges::move(group(), std::back_inserter(all));
    return all;
}

}  // namespace

const std::vector<CommandGuide>& command_guides() {
    static const std::vector<CommandGuide> guides = all_guides();
    return guides;
}

const CommandGuide* find_guide(std::string_view command) {
    const auto& guides = command_guides();
    const auto found = std::ranges::find(guides, command, &CommandGuide::command);
    return found == guides.end() ? nullptr : &*found;
}

}  // namespace stormcellar::cli
