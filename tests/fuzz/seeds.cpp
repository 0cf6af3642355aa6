#include "tests/fuzz/seeds.h"

#include <array>
#include <stdexcept>

#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"

namespace stormcellar::fuzz {
namespace {

namespace wire = level2::wire;
using wire::Bytes;

constexpr std::array<float, 3> elevations_deg = {0.5F, 1.5F, -0.5F};

Bytes legacy_radials(unsigned count) {
    Bytes all;
    for (unsigned i = 0; i < count; ++i) {
        wire::Ray ray;
        ray.azimuth_number = i + 1;
        ray.azimuth_deg = static_cast<float>(i);
        ray.status = i == 0 ? 3 : (i + 1 == count ? 4 : 1);
        ray.gates = 20;
        all = wire::join({all, wire::message_1(ray)});
    }
    return all;
}

// Returns a sweep that comes late: it is a minute older than the other sweeps.
Bytes older_sweep() {
    Bytes all;
    for (const unsigned number : {1U, 2U, 3U}) {
        wire::Ray ray;
        ray.azimuth_number = number;
        ray.azimuth_deg = static_cast<float>(number);
        ray.elevation_number = 3;
        ray.ms -= 60'000;
        ray.gates = 20;
        const Bytes message = wire::message_31(ray);
        all.insert(all.end(), message.begin(), message.end());
    }
    return all;
}

// Returns a small volume in LDM records. Its bzip2 blocks are small, so that they are packed and
// unpacked quickly.
Bytes ldm_volume() {
    const Bytes metadata = wire::join({wire::frame(0), wire::vcp_frame(212, elevations_deg)});
    const Bytes radials = wire::radial_messages(2, 3, 20);
    const std::span<const std::byte> sweeps = radials;
    return wire::join({wire::archive_header(), wire::ldm_record(metadata, false, 1),
                       wire::ldm_record(sweeps.first(radials.size() / 2), false, 1),
                       wire::ldm_record(sweeps.subspan(radials.size() / 2), true, 1)});
}

// Returns a volume as the project's own writer packs it.
Bytes written_volume() {
    auto decoded = level2::decode(ldm_volume());
    if (!decoded) throw std::runtime_error(decoded.error().message);
    const auto encoded = level2::encode(decoded->volume, {1, 2});
    if (!encoded) throw std::runtime_error(encoded.error().message);
    return encoded->joined();
}

}  // namespace

std::vector<Seed> messages_seeds() {
    const Bytes radials = wire::radial_messages(2, 3, 20);
    const Bytes vcp = wire::vcp_frame(212, elevations_deg);
    const Bytes lost{radials.begin() + 100, radials.end()};
    const Bytes second_volume =
        wire::join({radials, wire::archive_header("AR2V0006.117"), wire::frame(2), radials});
    return {
        {"radials", radials},
        {"metadata", wire::join({wire::frame(0), vcp, wire::frame(2), wire::frame(15)})},
        {"volume", wire::join({vcp, radials})},
        {"legacy", wire::join({vcp, legacy_radials(4)})},
        {"status_inside", wire::join({radials, wire::frame(2), radials})},
        {"second_volume", second_volume},
        {"bytes_lost", wire::join({radials, lost})},
        {"one_radial", wire::message_31({})},
        {"older_sweep", older_sweep()},
    };
}

std::vector<Seed> container_seeds() {
    const Bytes volume = ldm_volume();
    const Bytes stream = wire::join({wire::archive_header(), wire::radial_messages(1, 3, 20)});
    const Bytes legacy =
        wire::join({wire::archive_header("ARCHIVE2.031", std::string(4, '\0')), legacy_radials(3)});
    Bytes cut = volume;
    cut.resize(volume.size() - 40);
    Bytes flipped = volume;
    flipped[flipped.size() - 60] ^= std::byte{4};
    return {
        {"ldm", volume},
        {"written", written_volume()},
        {"uncompressed", stream},
        {"legacy", legacy},
        {"gzip", wire::gzip(stream)},
        {"gzip_ldm", wire::gzip(volume)},
        {"bzip2", wire::bzip2(stream, 1)},
        {"compress", wire::compress(stream, 12, 0)},
        {"cut", cut},
        {"flipped", flipped},
        {"two_headers", wire::join({volume, volume})},
        {"lone_record", wire::ldm_record(wire::radial_messages(1, 2, 10), false, 1)},
    };
}

std::vector<Seed> live_seeds() {
    std::vector<Seed> seeds;
    for (Seed& seed : container_seeds()) {
        Bytes order(8);
        order[7] = static_cast<std::byte>(seeds.size());
        seeds.push_back({std::move(seed.name), wire::join({order, seed.bytes})});
    }
    return seeds;
}

std::vector<Seed> compress_seeds() {
    const Bytes plain = wire::radial_messages(1, 2, 40);
    return {
        {"nothing", wire::compress({}, 16, 0)},
        {"nine_bits", wire::compress(plain, 9, 0)},
        {"ten_bits", wire::compress(plain, 10, 0)},
        {"twelve_bits", wire::compress(plain, 12, 0)},
        {"sixteen_bits", wire::compress(plain, 16, 0)},
        {"cleared", wire::compress(plain, 12, 100)},
        {"zeros", wire::compress(Bytes(5000), 12, 0)},
    };
}

}  // namespace stormcellar::fuzz
