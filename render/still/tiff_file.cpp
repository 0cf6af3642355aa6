#include "render/still/tiff_file.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

#include "base/parallel.h"

namespace stormcellar::render {
namespace {

static_assert(std::endian::native == std::endian::little, "rasters are written as they are");

using TiffBytes = std::vector<std::byte>;

constexpr int pack_level = 6;
constexpr std::size_t tile_frame_bytes = 8;  // four bytes before a tile, and four after it

// The types of fields (TIFF 6.0, section 2).
enum class FieldType : std::uint16_t { ascii = 2, u16 = 3, u32 = 4, f64 = 12 };

struct Field {
    std::uint16_t tag = 0;
    FieldType type = FieldType::u16;
    std::uint32_t count = 0;
    TiffBytes bytes;
};

template <class Number>
void put(TiffBytes& to, Number number) {
    const auto bytes = std::bit_cast<std::array<std::byte, sizeof number>>(number);
    to.insert(to.end(), bytes.begin(), bytes.end());
}

void put_text(TiffBytes& to, std::string_view text) {
    const auto bytes = std::as_bytes(std::span{text});
    to.insert(to.end(), bytes.begin(), bytes.end());
}

template <class Number>
Field field_of(std::uint16_t tag, FieldType type, const std::vector<Number>& numbers) {
    Field field{tag, type, static_cast<std::uint32_t>(numbers.size()), {}};
    for (const Number number : numbers)
        put(field.bytes, number);
    return field;
}

Field shorts(std::uint16_t tag, const std::vector<std::uint16_t>& numbers) {
    return field_of(tag, FieldType::u16, numbers);
}
Field longs(std::uint16_t tag, const std::vector<std::uint32_t>& numbers) {
    return field_of(tag, FieldType::u32, numbers);
}
Field doubles(std::uint16_t tag, const std::vector<double>& numbers) {
    return field_of(tag, FieldType::f64, numbers);
}
Field text_field(std::uint16_t tag, const std::string& text) {
    Field field{tag, FieldType::ascii, static_cast<std::uint32_t>(text.size() + 1), {}};
    put_text(field.bytes, text);
    field.bytes.push_back(std::byte{0});
    return field;
}

std::size_t pixel_bytes(TiffSamples samples) {
    return samples == TiffSamples::palette ? 1 : 4;
}

int tiles_along(int pixels) {
    return (pixels + tiff_tile_side - 1) / tiff_tile_side;
}

// Cuts out a tile. A tile that extends beyond the raster repeats its last column and row, which
// compress well and are never shown.
TiffBytes cut_tile(const TiffRaster& raster, std::size_t bytes_each, int tile) {
    const int across = tiles_along(raster.width);
    const int left = tile % across * tiff_tile_side;
    const int top = tile / across * tiff_tile_side;
    TiffBytes cut;
    cut.reserve(std::size_t{tiff_tile_side} * tiff_tile_side * bytes_each);
    for (int y = top; y < top + tiff_tile_side; ++y) {
        const int row = std::min(y, raster.height - 1);
        for (int x = left; x < left + tiff_tile_side; ++x) {
            const int column = std::min(x, raster.width - 1);
            const auto at =
                (static_cast<std::size_t>(row) * static_cast<std::size_t>(raster.width) +
                 static_cast<std::size_t>(column)) *
                bytes_each;
            cut.insert(cut.end(), raster.pixels.begin() + static_cast<std::ptrdiff_t>(at),
                       raster.pixels.begin() + static_cast<std::ptrdiff_t>(at + bytes_each));
        }
    }
    return cut;
}

// Returns the compressed bytes; empty if zlib refuses.
TiffBytes packed(const TiffBytes& from) {
    uLongf size = compressBound(static_cast<uLong>(from.size()));
    TiffBytes to(size);
    const int done =
        compress2(reinterpret_cast<Bytef*>(to.data()), &size,
                  reinterpret_cast<const Bytef*>(from.data()), from.size(), pack_level);
    to.resize(done == Z_OK ? size : 0);
    return to;
}

Result<std::vector<TiffBytes>> pack_tiles(const TiffRaster& raster, TiffSamples samples,
                                          int threads) {
    const int count = tiles_along(raster.width) * tiles_along(raster.height);
    std::vector<TiffBytes> tiles(static_cast<std::size_t>(count));
    std::atomic<bool> refused{false};
    for_each_piece(count, threads, [&](int tile) {
        TiffBytes& to = tiles[static_cast<std::size_t>(tile)];
        to = packed(cut_tile(raster, pixel_bytes(samples), tile));
        if (to.empty()) refused = true;
    });
    if (refused) return fail(ErrorCode::internal, "zlib cannot pack a tile");
    return tiles;
}

// Adds the keys of GeoTIFF as three fields: short numbers, doubles and texts.
void add_geo_fields(const TiffFacts& facts, std::vector<Field>& fields) {
    constexpr std::uint16_t pixel_scale_tag = 33550, tiepoint_tag = 33922, keys_tag = 34735;
    constexpr std::uint16_t doubles_tag = 34736, texts_tag = 34737;
    fields.push_back(doubles(pixel_scale_tag, {facts.pixel_size[0], facts.pixel_size[1], 0}));
    fields.push_back(doubles(tiepoint_tag, {0, 0, 0, facts.top_left[0], facts.top_left[1], 0}));
    std::vector<std::uint16_t> keys = {1, 1, 0, static_cast<std::uint16_t>(facts.geo_keys.size())};
    std::vector<double> numbers;
    std::string texts;
    for (const GeoKey& key : facts.geo_keys) {
        keys.push_back(key.id);
        if (!key.text.empty()) {
            keys.insert(keys.end(), {texts_tag, static_cast<std::uint16_t>(key.text.size() + 1),
                                     static_cast<std::uint16_t>(texts.size())});
            texts += key.text + '|';
        } else if (key.is_double) {
            keys.insert(keys.end(), {doubles_tag, 1, static_cast<std::uint16_t>(numbers.size())});
            numbers.push_back(key.value);
        } else {
            keys.insert(keys.end(), {0, 1, key.number});
        }
    }
    fields.push_back(shorts(keys_tag, keys));
    if (!numbers.empty()) fields.push_back(doubles(doubles_tag, numbers));
    if (!texts.empty()) fields.push_back(text_field(texts_tag, texts));
}

void add_sample_fields(const TiffFacts& facts, std::vector<Field>& fields) {
    constexpr std::uint16_t bits_tag = 258, photometric_tag = 262, samples_tag = 277;
    constexpr std::uint16_t palette_tag = 320, extra_tag = 338, format_tag = 339;
    switch (facts.samples) {
        case TiffSamples::gray_float:
            fields.push_back(shorts(bits_tag, {32}));
            fields.push_back(shorts(photometric_tag, {1}));  // black is 0
            fields.push_back(shorts(samples_tag, {1}));
            fields.push_back(shorts(format_tag, {3}));  // IEEE
            return;
        case TiffSamples::palette: {
            std::vector<std::uint16_t> colors(3 * 256, 0);
            for (std::size_t i = 0; i < facts.palette.size(); ++i) {
                for (std::size_t part = 0; part < 3; ++part)
                    colors[part * 256 + i] =
                        static_cast<std::uint16_t>(facts.palette[i][part] * 257);
            }
            fields.push_back(shorts(bits_tag, {8}));
            fields.push_back(shorts(photometric_tag, {3}));
            fields.push_back(shorts(samples_tag, {1}));
            fields.push_back(shorts(palette_tag, colors));
            return;
        }
        case TiffSamples::rgba:
            fields.push_back(shorts(bits_tag, {8, 8, 8, 8}));
            fields.push_back(shorts(photometric_tag, {2}));
            fields.push_back(shorts(samples_tag, {4}));
            fields.push_back(shorts(extra_tag, {2}));  // alpha that is not premultiplied
            return;
    }
}

// Returns the fields of one raster. The offsets of its tiles are set later.
std::vector<Field> fields_of(const TiffRaster& raster, const std::vector<TiffBytes>& tiles,
                             const TiffFacts& facts, bool is_overview) {
    std::vector<std::uint32_t> sizes;
    for (const TiffBytes& tile : tiles)
        sizes.push_back(static_cast<std::uint32_t>(tile.size()));
    std::vector<Field> fields = {
        longs(254, {is_overview ? 1U : 0U}),  // NewSubfileType
        longs(256, {static_cast<std::uint32_t>(raster.width)}),
        longs(257, {static_cast<std::uint32_t>(raster.height)}),
        shorts(259, {8}),  // Compression: deflate
        shorts(284, {1}),  // PlanarConfiguration: pixel by pixel
        shorts(322, {tiff_tile_side}),
        shorts(323, {tiff_tile_side}),
        longs(324, std::vector<std::uint32_t>(tiles.size())),  // TileOffsets
        longs(325, sizes),                                     // TileByteCounts
    };
    add_sample_fields(facts, fields);
    if (!is_overview) {
        const auto add_text = [&](std::uint16_t tag, const std::string& text) {
            if (!text.empty()) fields.push_back(text_field(tag, text));
        };
        add_text(270, facts.description);
        add_text(305, facts.software);
        add_text(306, facts.date_time);
        add_text(42112, facts.gdal_metadata);
        add_geo_fields(facts, fields);
    }
    if (!facts.gdal_nodata.empty()) fields.push_back(text_field(42113, facts.gdal_nodata));
    std::ranges::sort(fields, {}, &Field::tag);
    return fields;
}

constexpr std::size_t entry_bytes = 12;

// Returns true for a value of more than four bytes, which is stored after the directory instead of
// in its entry.
bool stands_behind(const Field& field) {
    return field.bytes.size() > 4;
}

std::size_t whole_words(std::size_t bytes) {
    return (bytes + 1) / 2 * 2;  // offsets are even
}

std::size_t directory_bytes(const std::vector<Field>& fields) {
    std::size_t size = 2 + fields.size() * entry_bytes + 4;
    for (const Field& field : fields) {
        if (stands_behind(field)) size += whole_words(field.bytes.size());
    }
    return size;
}

void put_directory(TiffBytes& file, const std::vector<Field>& fields, std::uint32_t next) {
    std::size_t behind = file.size() + 2 + fields.size() * entry_bytes + 4;
    TiffBytes values;
    put(file, static_cast<std::uint16_t>(fields.size()));
    for (const Field& field : fields) {
        put(file, field.tag);
        put(file, static_cast<std::uint16_t>(field.type));
        put(file, field.count);
        TiffBytes entry = field.bytes;
        if (stands_behind(field)) {
            values.insert(values.end(), entry.begin(), entry.end());
            entry.clear();
            put(entry, static_cast<std::uint32_t>(behind));
            behind += whole_words(field.bytes.size());
            values.resize(whole_words(values.size()));
        }
        entry.resize(4);
        file.insert(file.end(), entry.begin(), entry.end());
    }
    put(file, next);
    file.insert(file.end(), values.begin(), values.end());
}

// Returns the text that GDAL's COG driver writes before the first directory and looks for when it
// reads.
std::string layout_text() {
    const std::string lines =
        "LAYOUT=IFDS_BEFORE_DATA\n"
        "BLOCK_ORDER=ROW_MAJOR\n"
        "BLOCK_LEADER=SIZE_AS_UINT4\n"
        "BLOCK_TRAILER=LAST_4_BYTES_REPEATED\n"
        "KNOWN_INCOMPATIBLE_EDITION=NO\n ";  // with room for YES in place of NO
    return fmt::format("GDAL_STRUCTURAL_METADATA_SIZE={:06} bytes\n{}", lines.size(), lines);
}

Status check_rasters(const std::vector<TiffRaster>& rasters, TiffSamples samples) {
    if (rasters.empty()) return fail(ErrorCode::bad_argument, "TIFF: there is no raster");
    for (const TiffRaster& raster : rasters) {
        const auto pixels =
            static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);
        if (raster.width < 1 || raster.height < 1 ||
            raster.pixels.size() != pixels * pixel_bytes(samples)) {
            return fail(ErrorCode::bad_argument,
                        "TIFF: a raster of {} by {} pixels cannot have {} bytes", raster.width,
                        raster.height, raster.pixels.size());
        }
    }
    return {};
}

// Places the tiles. Small rasters come first, so that a sequential reader can soon show something.
// Returns the size of the file.
std::size_t place_tiles(std::size_t at, const std::vector<std::vector<TiffBytes>>& tiles,
                        std::vector<std::vector<Field>>& directories) {
    for (std::size_t raster = tiles.size(); raster-- > 0;) {
        std::vector<std::uint32_t> offsets;
        for (const TiffBytes& tile : tiles[raster]) {
            offsets.push_back(static_cast<std::uint32_t>(at + tile_frame_bytes / 2));
            at += tile.size() + tile_frame_bytes;
        }
        auto& fields = directories[raster];
        *std::ranges::find(fields, 324, &Field::tag) = longs(324, offsets);
    }
    return at;
}

void put_tile(TiffBytes& file, const TiffBytes& tile) {
    put(file, static_cast<std::uint32_t>(tile.size()));
    file.insert(file.end(), tile.begin(), tile.end());
    TiffBytes last(tile.end() - static_cast<std::ptrdiff_t>(std::min<std::size_t>(4, tile.size())),
                   tile.end());
    last.resize(4);
    file.insert(file.end(), last.begin(), last.end());
}

}  // namespace

Result<std::vector<std::byte>> write_tiff(const std::vector<TiffRaster>& rasters,
                                          const TiffFacts& facts, int threads) {
    if (auto sound = check_rasters(rasters, facts.samples); !sound) return pass_on(sound);
    std::vector<std::vector<TiffBytes>> tiles;
    std::vector<std::vector<Field>> directories;
    for (const TiffRaster& raster : rasters) {
        auto packed_tiles = pack_tiles(raster, facts.samples, threads);
        if (!packed_tiles) return pass_on(packed_tiles);
        tiles.push_back(std::move(*packed_tiles));
        directories.push_back(fields_of(raster, tiles.back(), facts, directories.size() > 0));
    }
    const std::string layout = layout_text();
    constexpr std::size_t header_bytes = 8;
    const std::size_t first = whole_words(header_bytes + layout.size());
    std::size_t end = first;
    for (const auto& fields : directories)
        end += directory_bytes(fields);
    const std::size_t size = place_tiles(end, tiles, directories);
    if (size > std::numeric_limits<std::uint32_t>::max()) {
        return fail(ErrorCode::unsupported, "TIFF: the file would have {} bytes, more than 4 GiB",
                    size);
    }
    TiffBytes file;
    file.reserve(size);
    put_text(file, "II");
    put(file, std::uint16_t{42});
    put(file, static_cast<std::uint32_t>(first));
    put_text(file, layout);
    file.resize(first);
    for (std::size_t i = 0; i < directories.size(); ++i) {
        const std::size_t next = file.size() + directory_bytes(directories[i]);
        put_directory(file, directories[i],
                      i + 1 < directories.size() ? static_cast<std::uint32_t>(next) : 0);
    }
    for (std::size_t raster = tiles.size(); raster-- > 0;) {
        for (const TiffBytes& tile : tiles[raster])
            put_tile(file, tile);
    }
    return file;
}

}  // namespace stormcellar::render
