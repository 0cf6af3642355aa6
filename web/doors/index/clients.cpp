#include "web/doors/index/clients.h"

#include <algorithm>
#include <array>
#include <utility>

namespace stormcellar::web {
namespace {

// {base}, {bucket}, {station}, {domain}, {moment}, {day} and {when} in `code` are filled in.
struct ClientRow {
    std::string_view program, door;
    std::string_view unless;  // another door whose row is better; empty: none
    std::string_view text, code;
};

constexpr std::array client_rows = {
    ClientRow{"GR2Analyst, GRLevel2", "/nexrd2", "", "Give this as the polling address.",
              "{base}/nexrd2"},
    ClientRow{"Python: Siphon", "/thredds", "",
              "The THREDDS radar server answers Siphon's queries.",
              "from datetime import datetime\n"
              "from siphon.radarserver import RadarServer\n"
              "\n"
              "server = RadarServer('{base}/thredds/radarServer/nexrad/level2/IDD/')\n"
              "query = server.query()\n"
              "query.stations('{station}').time(datetime({when}))\n"
              "for dataset in server.get_catalog(query).datasets.values():\n"
              "    dataset.download()"},
    ClientRow{"Python: xarray", "/zarr", "",
              "Every domain and moment is one array over time; chunks are fetched as they are "
              "needed.",
              "import xarray as xr\n"
              "\n"
              "grids = xr.open_zarr('{base}/zarr/{domain}/{moment}/')\n"
              "print(grids.isel(time=-1))"},
    ClientRow{"Python: xarray", "/api/v1", "/zarr", "Each grid is a CF netCDF file.",
              "curl -o grid.nc {base}/api/v1/grids/{domain}/{moment}/latest/netcdf\n"
              "python3 -c \"import xarray; print(xarray.open_dataset('grid.nc'))\""},
    ClientRow{
        "rclone", "/s3", "", "Raw volumes lie in a bucket, under the names of the public one.",
        "rclone copy ':s3,provider=Other,endpoint=\"{base}/s3\":{bucket}/{day}/{station}/' ."},
    ClientRow{"AWS command line", "/s3", "", "No account is needed.",
              "aws --no-sign-request --region us-east-1 --endpoint-url {base}/s3 \\\n"
              "    s3 ls s3://{bucket}/{day}/{station}/"},
    ClientRow{"curl: the newest volume", "/volumes", "",
              "A list of what there is, and each file with ranges.",
              "curl '{base}/volumes/{station}/?limit=1'"},
    ClientRow{"curl: events", "/api/v1/events", "",
              "A line for each sweep, volume and mosaic, as it happens.",
              "curl -N '{base}/api/v1/events?station={station}'"},
    ClientRow{
        "IDV", "/thredds", "",
        "Add this catalog in the chooser of radar data. The IDV asks by https, so a proxy with "
        "a certificate must stand before this server.",
        "{base}/thredds/radarServer/catalog.xml"},
    ClientRow{"Leaflet, OpenLayers, MapLibre", "/tiles", "",
              "Tiles of 2D products; TileJSON says where they are.",
              "{base}/tiles/{domain}/composite.{moment}/latest/tilejson.json"},
    ClientRow{"QGIS and others: WMS", "/wms", "", "Add this as a WMS connection.", "{base}/wms"},
    ClientRow{"Prometheus", "/metrics", "", "What this server did and holds.", "{base}/metrics"},
};

std::string filled(std::string_view code, const ClientPlaces& places) {
    const std::array<std::pair<std::string_view, const std::string*>, 7> words = {
        {{"base", &places.base},
         {"bucket", &places.bucket},
         {"station", &places.station},
         {"domain", &places.domain},
         {"moment", &places.moment},
         {"day", &places.day},
         {"when", &places.when}}};
    std::string text;
    while (!code.empty()) {
        const std::size_t open = code.find('{');
        text += code.substr(0, open);
        if (open == std::string_view::npos) break;
        code.remove_prefix(open + 1);
        const std::size_t close = code.find('}');
        for (const auto& [word, value] : words)
            if (word == code.substr(0, close)) text += *value;
        code.remove_prefix(close + 1);
    }
    return text;
}

}  // namespace

std::vector<ClientHelp> client_help(const ClientPlaces& places,
                                    const std::vector<std::string>& doors) {
    const auto has = [&](std::string_view door) {
        return std::find(doors.begin(), doors.end(), door) != doors.end();
    };
    std::vector<ClientHelp> help;
    for (const ClientRow& row : client_rows) {
        if (!has(row.door) || (!row.unless.empty() && has(row.unless))) continue;
        help.push_back({row.program, row.text, filled(row.code, places)});
    }
    return help;
}

}  // namespace stormcellar::web
