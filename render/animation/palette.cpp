#include "render/animation/palette.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace stormcellar::render {
namespace {

constexpr std::size_t most_exact = 256;
constexpr int refinement_rounds = 2;

// Weights of red, green and blue. The eye distinguishes green better than red, and red better than
// blue.
constexpr std::array<double, 3> channel_weight = {2, 4, 3};

// A color. Its channels are scaled by their weights.
using Point = std::array<double, 3>;

// An item to be grouped: the color of a cell of the histogram, and the number of its pixels.
struct Sample {
    Point point{};
    double count = 0;
    Rgb8 color{};
    bool exact = false;  // at least half of the pixels have exactly this color
};

std::uint32_t packed(Rgb8 color) {
    return (static_cast<std::uint32_t>(color[0]) << 16) |
           (static_cast<std::uint32_t>(color[1]) << 8) | color[2];
}

Rgb8 unpacked(std::uint32_t color) {
    return {static_cast<std::uint8_t>(color >> 16), static_cast<std::uint8_t>(color >> 8),
            static_cast<std::uint8_t>(color)};
}

Point point_of(Rgb8 color) {
    Point point{};
    for (std::size_t c = 0; c < 3; ++c)
        point[c] = color[c] * channel_weight[c];
    return point;
}

Rgb8 color_of(const Point& point) {
    Rgb8 color{};
    for (std::size_t c = 0; c < 3; ++c) {
        color[c] =
            static_cast<std::uint8_t>(std::clamp(point[c] / channel_weight[c] + 0.5, 0.0, 255.0));
    }
    return color;
}

double distance_squared(const Point& a, const Point& b) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c)
        sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

// Sums over a range of samples, from which the mean and the spread follow.
struct Moments {
    double count = 0;
    Point sum{};
    double squares = 0;

    void add(const Sample& sample) {
        count += sample.count;
        for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += sample.count * sample.point[c];
            squares += sample.count * sample.point[c] * sample.point[c];
        }
    }
    // Returns |sum|^2 / count, the part of the sum of squares that a single mean explains.
    [[nodiscard]] double explained() const {
        if (count <= 0) return 0;
        return (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / count;
    }
    [[nodiscard]] double spread() const { return squares - explained(); }
    [[nodiscard]] Point mean() const { return {sum[0] / count, sum[1] / count, sum[2] / count}; }
};

Moments moments_of(std::span<const Sample> samples) {
    Moments moments;
    for (const Sample& sample : samples)
        moments.add(sample);
    return moments;
}

struct Box {
    std::span<Sample> samples;
    Moments moments;
};

struct Split {
    double gain = 0;
    std::size_t channel = 0;
    std::size_t position = 0;  // number of samples that go to the first side
};

void sort_by_channel(std::span<Sample> samples, std::size_t channel) {
    std::ranges::sort(samples, [channel](const Sample& a, const Sample& b) {
        if (a.point[channel] != b.point[channel]) return a.point[channel] < b.point[channel];
        // Without this, equal channels would keep an order that depends on the earlier sorting.
        return packed(a.color) < packed(b.color);
    });
}

// Returns the cut, across one channel, that reduces the spread most.
Split best_split(const Box& box) {
    Split best;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        sort_by_channel(box.samples, channel);
        Moments left;
        for (std::size_t i = 1; i < box.samples.size(); ++i) {
            left.add(box.samples[i - 1]);
            Moments right = box.moments;
            right.count -= left.count;
            for (std::size_t c = 0; c < 3; ++c)
                right.sum[c] -= left.sum[c];
            const double gain = left.explained() + right.explained() - box.moments.explained();
            if (gain > best.gain) best = {gain, channel, i};
        }
    }
    return best;
}

// Splits the box that has the greatest spread, again and again, and returns the means of the boxes.
std::vector<Point> split_into(std::vector<Sample>& samples, std::size_t size) {
    std::vector<Box> boxes{{samples, moments_of(samples)}};
    while (boxes.size() < size) {
        const auto widest = std::ranges::max_element(
            boxes, {}, [](const Box& box) { return box.moments.spread(); });
        const Split split = best_split(*widest);
        if (split.position == 0) break;  // all samples are equal
        sort_by_channel(widest->samples, split.channel);
        const auto left = widest->samples.first(split.position);
        const auto right = widest->samples.subspan(split.position);
        *widest = {left, moments_of(left)};
        boxes.push_back({right, moments_of(right)});
    }
    std::vector<Point> means;
    means.reserve(boxes.size());
    for (const Box& box : boxes)
        means.push_back(box.moments.mean());
    return means;
}

std::size_t nearest_point(const std::vector<Point>& points, const Point& point) {
    std::size_t best = 0;
    double best_distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double distance = distance_squared(points[i], point);
        if (distance < best_distance) {
            best = i;
            best_distance = distance;
        }
    }
    return best;
}

// Returns a color for each group: the exact color that makes up half of the group, if there is one,
// or else the mean of the group.
std::vector<Rgb8> refine(const std::vector<Sample>& samples, std::vector<Point> points) {
    std::vector<Moments> groups;
    std::vector<const Sample*> largest;
    for (int round = 0; round < refinement_rounds; ++round) {
        groups.assign(points.size(), {});
        largest.assign(points.size(), nullptr);
        for (const Sample& sample : samples) {
            const std::size_t group = nearest_point(points, sample.point);
            groups[group].add(sample);
            if (largest[group] == nullptr || sample.count > largest[group]->count) {
                largest[group] = &sample;
            }
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (groups[i].count > 0) points[i] = groups[i].mean();
        }
    }
    std::vector<Rgb8> palette;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Sample* leader = largest[i];
        const bool rules =
            leader != nullptr && leader->exact && leader->count * 2 >= groups[i].count;
        palette.push_back(rules ? leader->color : color_of(points[i]));
    }
    return palette;
}

// Calls `visit` for each run of equal pixels. A drawn picture has many long runs.
template <class Visit>
void for_each_run(const Image& frame, Visit visit) {
    const auto& rgba = frame.rgba;
    std::size_t i = 0;
    while (i < rgba.size()) {
        const Rgb8 color{rgba[i], rgba[i + 1], rgba[i + 2]};
        std::size_t end = i + 4;
        while (end < rgba.size() && rgba[end] == color[0] && rgba[end + 1] == color[1] &&
               rgba[end + 2] == color[2]) {
            end += 4;
        }
        visit(color, (end - i) / 4);
        i = end;
    }
}

}  // namespace

ColorHistogram::ColorHistogram() : cells_(std::size_t{64} * 64 * 64) {}

void ColorHistogram::add(const Image& frame) {
    for_each_run(frame, [this](Rgb8 color, std::size_t length) { add_run(color, length); });
}

void ColorHistogram::add_run(Rgb8 color, std::uint64_t length) {
    if (!too_many_) {
        exact_.insert(packed(color));
        if (exact_.size() > most_exact) {
            too_many_ = true;
            exact_.clear();
        }
    }
    Cell& cell = cells_[(static_cast<std::size_t>(color[0] >> 2) << 12) |
                        (static_cast<std::size_t>(color[1] >> 2) << 6) | (color[2] >> 2)];
    cell.count += length;
    for (std::size_t c = 0; c < 3; ++c)
        cell.sum[c] += length * color[c];
    if (cell.leader == color) {
        cell.lead += length;
    } else if (cell.lead >= length) {
        cell.lead -= length;
    } else {
        cell.leader = color;
        cell.lead = length - cell.lead;
    }
}

std::vector<Rgb8> ColorHistogram::palette(std::size_t size) const {
    if (!too_many_ && exact_.size() <= size) {
        std::vector<std::uint32_t> colors(exact_.begin(), exact_.end());
        std::ranges::sort(colors);
        std::vector<Rgb8> palette(colors.size());
        std::ranges::transform(colors, palette.begin(), unpacked);
        return palette;
    }
    std::vector<Sample> samples;
    for (const Cell& cell : cells_) {
        if (cell.count == 0) continue;
        Sample sample;
        sample.count = static_cast<double>(cell.count);
        // A leader that is this far ahead has at least half of the pixels.
        sample.exact = cell.lead * 2 >= cell.count;
        sample.color = cell.leader;
        if (!sample.exact) {
            for (std::size_t c = 0; c < 3; ++c) {
                sample.color[c] =
                    static_cast<std::uint8_t>((cell.sum[c] + cell.count / 2) / cell.count);
            }
        }
        sample.point = point_of(sample.color);
        samples.push_back(sample);
    }
    auto points = split_into(samples, size);
    return refine(samples, std::move(points));
}

PaletteMap::PaletteMap(std::vector<Rgb8> palette)
    : palette_(std::move(palette)), known_(1U << 16) {}

std::uint8_t PaletteMap::nearest(Rgb8 color) {
    const std::uint32_t key = packed(color);
    Known& known = known_[(key * 2654435761U) >> 16];
    if (known.color == key) return known.index;
    int best = 0;
    int best_distance = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < palette_.size(); ++i) {
        int distance = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const int difference =
                (palette_[i][c] - color[c]) * static_cast<int>(channel_weight[c]);
            distance += difference * difference;
        }
        if (distance < best_distance) {
            best = static_cast<int>(i);
            best_distance = distance;
        }
    }
    known = {key, static_cast<std::uint8_t>(best)};
    return known.index;
}

std::vector<std::uint8_t> PaletteMap::indices(const Image& frame) {
    std::vector<std::uint8_t> indices;
    indices.reserve(frame.rgba.size() / 4);
    for_each_run(frame, [&](Rgb8 color, std::size_t length) {
        indices.insert(indices.end(), length, nearest(color));
    });
    return indices;
}

}  // namespace stormcellar::render
