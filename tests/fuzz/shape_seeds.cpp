#include <cstring>
#include <string_view>
#include <utility>

#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {

std::vector<Seed> shape_seeds() {
    constexpr std::pair<const char*, std::string_view> texts[] = {
        {"warning",
         R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{
"event":"Tornado Warning","onset":"2016-06-01T10:02:00-05:00","ends":null,"expires":"201606011545",
"stroke":"#f80","stroke-width":3},"geometry":{"type":"Polygon","coordinates":
[[[-102,33],[-101,33],[-101,34],[-102,33]]]}}]})"},
        {"geometries",
         R"({"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2]},
{"type":"MultiPoint","coordinates":[[1,2],[3,4]]},{"type":"LineString","coordinates":[[1,2],[3,4]]},
{"type":"MultiPolygon","coordinates":[[[[1,2],[3,4],[5,6],[1,2]]]]}]})"},
        {"label", R"({"type":"Feature","properties":{"name":"Café","begin":"Main St"},
"geometry":{"type":"Point","coordinates":[370.5,-89.9,100]}})"},
        {"lines",
         "; comment\nTitle: a\nColor: 255 128 0\nLine: 4, 0, \"a, b\"\n33.5, -102\n33.6, -101.9\n"
         "End:\nPolygon:\n33, -102 ; first\n33, -101\n34, -101\n33, -102\n1, 2\n3, 4\nEnd:\n"},
        {"objects",
         "TimeRange: 2016-06-01T15:00:00Z 2016-06-01T16:00:00Z\nObject: 34, -101.5\n"
         "Icon: 0, 0, 45, 1, 1, \"hover\"\nLine: 1, 0\n0, 0\n5, 5\nEnd:\nText: 10, 0, 1, \"x\"\n"
         "End:\nPlace: 35, -98, Caf\xe9\nTriangles:\n1, 2\nEnd:\n"},
    };
    std::vector<Seed> seeds;
    for (const auto& [name, text] : texts) {
        Seed seed{name, level2::wire::Bytes(text.size())};
        std::memcpy(seed.bytes.data(), text.data(), text.size());
        seeds.push_back(std::move(seed));
    }
    return seeds;
}

}  // namespace stormcellar::fuzz
