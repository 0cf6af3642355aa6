#include "cli/reference/command_guide.h"

#include <algorithm>
#include <iterator>

namespace stormcellar::cli {
namespace {

using Guides = std::vector<CommandGuide>;

Guides guides_of_use() {
    return {
        {"",
         {{"stormcellar info KTLX19990503_235621.gz", "What a file holds."},
          {"stormcellar frame KTLX19990503_235621.gz -o storm.png", "The storm, as a picture."},
          {"stormcellar frame KTLX --cache CACHE -o now.png",
           "The newest storm that the daemon gridded."},
          {"stormcellar loop KTLX --cache CACHE --from -1h -o storm.webp", "Its last hour."},
          {"stormcellar help frame", "What a command can do."}}},
        {"help", {{"stormcellar help catalog get", "The help of one command."}}},
        {"serve",
         {{"stormcellar serve KTLX19990503_235621.gz",
           "This volume and its grids, for a browser, Siphon, xarray, a GIS."},
          {"stormcellar serve --cache CACHE --catalog STATE/catalog",
           "What a daemon keeps, on another port than its own server."},
          {"stormcellar serve files/ --listen 192.168.1.5:8090 --allow-host radar-pc",
           "The same for the machines of this network."}}},
        {"view",
         {{"stormcellar view KTLX19990503_235621.gz",
           "This storm, to be turned and flown through."},
          {"stormcellar view files/ --no-browser",
           "The same of many volumes; the address is printed, but no browser is opened."}}},
        {"status",
         {{"stormcellar status", "How the daemon of this machine is."},
          {"stormcellar status --config stormcellard.toml", "How another daemon is."}}},
    };
}

Guides guides_of_files() {
    return {
        {"fetch",
         {{"stormcellar fetch --stations KTLX --from 1999-05-03T23:00:00Z --to "
           "1999-05-03T23:59:00Z -o files",
           "The volumes of an hour of one radar."}}},
        {"info",
         {{"stormcellar info KTLX19990503_235621.gz", "The sweeps, moments and times."},
          {"stormcellar info KTLX19990503_235621.gz --to volume.nc",
           "Also write the volume as CfRadial."}}},
        {"replay",
         {{"stormcellar replay files/ DROP --speed 10",
           "Play a directory of volumes ten times as fast as they came."}}},
        {"synth",
         {{"stormcellar synth supercell.toml -o files", "The volumes of a simulated storm."}}},
    };
}

Guides guides_of_batch() {
    return {
        {"batch check",
         {{"stormcellar batch check --plan PLAN --table",
           "How far it is, and what there is of each station and hour."}}},
        {"batch merge", {{"stormcellar batch merge --plan PLAN --task 160", "One hour's frames."}}},
        {"batch plan",
         {{"stormcellar batch plan --source files/ --from 1999-05-03 --to 1999-05-04 -o PLAN",
           "Own grids of all stations, two days."},
          {"stormcellar batch plan --source files/ --from 1999-05-03T20:00 --to 1999-05-04T02:00 "
           "--mosaic oklahoma --bounds=-100,33.5,-95,37 -o PLAN",
           "A mosaic every five minutes."},
          {"stormcellar batch plan --source https://unidata-nexrad-level2.s3.amazonaws.com "
           "--stations KTLX,KFDR --from 1999-05-03 --to 1999-05-04 -o PLAN",
           "Raw files from the public bucket, fetched by each task."}},
         {"--source", "--from", "--to", "--stations", "--bounds", "--output", "--cache", "--moment",
          "--mosaic", "--spacing-km"}},
        {"batch run",
         {{"stormcellar batch run --plan PLAN --task 12", "One station's day."},
          {"stormcellar batch run --plan PLAN --task 12-19", "Eight of them."}}},
        {"batch statistics",
         {{"stormcellar batch statistics --plan PLAN --by hour -o climatology.nc",
           "How often it rained where, by hour of the day."}}},
        {"batch submit",
         {{"stormcellar batch submit --plan PLAN --engine local", "On this machine."},
          {"stormcellar batch submit --plan PLAN --engine slurm --dry-run",
           "What Slurm would be told."}}},
    };
}

Guides guides_of_cache() {
    return {
        {"cache evict",
         {{"stormcellar cache evict --cache CACHE --bytes '20 GB' --dry-run",
           "What would go, so that 20 GB stay."},
          {"stormcellar cache evict --cache CACHE --older-than 48",
           "Remove the grids of more than two days ago."}}},
        {"cache list",
         {{"stormcellar cache list --cache CACHE --domain KTLX --from -1h",
           "The grids of the last hour."}}},
        {"cache pin",
         {{"stormcellar cache pin --cache CACHE --domain KTLX --from -1h",
           "Keep the last hour for good."}}},
        {"cache stat",
         {{"stormcellar cache stat --cache CACHE", "What each domain holds, and its size."}}},
        {"cache unpin",
         {{"stormcellar cache unpin --cache CACHE --domain KTLX", "Let them go again."}}},
        {"cache verify", {{"stormcellar cache verify --cache CACHE", "Read every grid."}}},
    };
}

Guides guides_of_catalog() {
    return {
        {"catalog check",
         {{"stormcellar catalog check --catalog STATE/catalog",
           "Compare what the catalog says with the files."}}},
        {"catalog get",
         {{"stormcellar catalog get --catalog STATE/catalog --station KTLX --from -1h -o files",
           "Copy the raw files of the last hour."}}},
        {"catalog latest",
         {{"stormcellar catalog latest --catalog STATE/catalog --station KTLX",
           "When the newest volume began."}}},
        {"catalog list",
         {{"stormcellar catalog list --catalog STATE/catalog --station KTLX --from -1h",
           "The volumes of the last hour."}}},
        {"catalog oldest",
         {{"stormcellar catalog oldest --catalog STATE/catalog --station KTLX",
           "When the oldest volume began."}}},
        {"catalog rebuild",
         {{"stormcellar catalog rebuild --catalog STATE/catalog --drop DROP",
           "Register all files anew if a database is damaged."}}},
        {"catalog stations",
         {{"stormcellar catalog stations --catalog STATE/catalog", "Whose files there are."}}},
    };
}

Guides guides_of_grids() {
    return {
        {"accuracy",
         {{"stormcellar accuracy KTLX19990503_235621.gz",
           "What each more accurate way to grid this volume costs, and what it gains."},
          {"stormcellar accuracy KTLX19990503_235621.gz --plot ladder.svg",
           "The same, with a plot."},
          {"stormcellar accuracy --picture KTLX19990503_235621.gz",
           "What a more accurate picture costs."},
          {"stormcellar accuracy --compare-sites KTLX.gz KFDR.gz",
           "How well two radars agree where both see the same air."}},
         {"--moment", "--plot", "--picture", "--held-out", "--compare-sites", "--scene", "--time",
          "--extent-km", "--spacing-km", "--levels-km"}},
        {"grid",
         {{"stormcellar grid KTLX19990503_235621.gz -o storm.nc",
           "A volume as a 3D grid in netCDF."},
          {"stormcellar grid KTLX19990503_235621.gz -o storm.nc --tolerance '250 m, 3 dB' "
           "--explain",
           "As cheap as these errors allow, and why."},
          {"stormcellar grid KTLX.gz KFDR.gz -o both.nc --time 1999-05-03T23:55:00Z",
           "A mosaic of two radars at one instant."}},
         {"--output", "--moment", "--center", "--extent-km", "--spacing-km", "--levels-km",
          "--time", "--method", "--tolerance", "--explain"}},
    };
}

Guides guides_of_pictures() {
    return {
        {"frame",
         {{"stormcellar frame KTLX19990503_235621.gz -o storm.png",
           "A file, as a volume; the view fits the storms."},
          {"stormcellar frame KTLX19990503_235621.gz --product composite -o map.png",
           "The greatest value of each column, as a map."},
          {"stormcellar frame KTLX --cache CACHE -o now.png",
           "The newest grid of a station that a daemon has made."},
          {"stormcellar frame KTLX --cache CACHE --product section "
           "--section 35.2,-98.2,35.5,-97 -o cut.png",
           "A vertical cut between two places."},
          {"stormcellar frame KTLX19990503_235621.gz --product ppi --moment VEL --elevation 0.5 "
           "-o tilt.png",
           "The velocity of the lowest sweep, gate by gate."},
          {"stormcellar frame KTLX --cache CACHE --probe-at 35.33,-97.5", "The value at a place."}},
         {"--output", "--cache", "--time", "--product", "--moment", "--colors", "--scene",
          "--azimuth", "--tilt", "--zoom"}},
        {"loop",
         {{"stormcellar loop KTLX --cache CACHE --from -1h -o storm.webp",
           "The last hour of a station."},
          {"stormcellar loop KTLX --cache CACHE --last 12 --product composite -o map.mp4",
           "The last twelve grids, as a map."},
          {"stormcellar loop KTLX --catalog STATE/catalog --from 1999-05-03T23:00:00Z --to "
           "1999-05-03T23:59:00Z -o tornado.webp",
           "An hour of an archive, gridded on the way."},
          {"stormcellar loop KTLX19990503_235621.gz --product ppi --all-elevations -o up.webp",
           "All sweeps of a volume, from the lowest up."}},
         {"--output", "--cache", "--from", "--to", "--last", "--product", "--moment", "--orbit",
          "--fps", "--follow"}},
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
