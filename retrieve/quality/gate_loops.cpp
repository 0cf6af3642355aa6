#include "retrieve/quality/gate_loops.h"

#include <algorithm>
#include <limits>

#include "retrieve/quality/gate_field.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "retrieve/quality/gate_loops.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stormcellar::retrieve::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Compilers vectorize the loops over integers by themselves, for each target.
template <class Code>
HWY_INLINE void keep_valid(const Code* HWY_RESTRICT codes, std::size_t gates,
                           std::uint16_t first_valid, std::uint16_t* HWY_RESTRICT valid) {
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const std::uint16_t code = codes[gate];
        valid[gate] = code >= first_valid ? code : std::uint16_t{0};
    }
}
void keep_valid_8(const std::uint8_t* codes, std::size_t gates, std::uint16_t first_valid,
                  std::uint16_t* valid) {
    keep_valid(codes, gates, first_valid, valid);
}
void keep_valid_16(const std::uint16_t* codes, std::size_t gates, std::uint16_t first_valid,
                   std::uint16_t* valid) {
    keep_valid(codes, gates, first_valid, valid);
}

void number_codes(const std::uint16_t* HWY_RESTRICT codes, std::size_t gates, std::uint32_t most,
                  std::uint32_t* HWY_RESTRICT numbers) {
    constexpr std::uint32_t one = 1U << BoxSum::sum_bits;
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const std::uint32_t code = codes[gate];
        const std::uint32_t number = one + (code < most ? code : most);
        numbers[gate] = code != 0 ? number : 0;
    }
}

void number_differences(const std::uint16_t* HWY_RESTRICT codes,
                        const std::uint16_t* HWY_RESTRICT others, std::size_t gates,
                        const CodeDifferences& differences, std::uint32_t* HWY_RESTRICT numbers) {
    constexpr std::int32_t one = 1 << BoxSum::sum_bits;
    const std::int32_t turn = differences.turn, most = differences.most;
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const std::int32_t a = codes[gate], b = others[gate];
        const std::int32_t between = a > b ? a - b : b - a;
        const std::int32_t around = turn > between ? turn - between : between - turn;
        const std::int32_t shorter = between < around ? between : around;
        const std::int32_t apart = shorter < most ? shorter : most;
        const std::int32_t number = one + apart * apart;
        numbers[gate] = static_cast<std::uint32_t>(a == 0 || b == 0 ? 0 : number);
    }
}

void sum_windows(std::uint32_t* HWY_RESTRICT numbers, std::size_t gates, unsigned window,
                 std::uint32_t* HWY_RESTRICT sums) {
    // Doubles the length of the sums as often as possible, and adds the sums that make up the
    // window.
    std::size_t length = 1, begin = 0, count = gates + window - 1;
    for (unsigned left = window;; left >>= 1U) {
        if ((left & 1U) != 0) {
            const std::uint32_t* HWY_RESTRICT from = numbers + begin;
            if (begin == 0)
                for (std::size_t gate = 0; gate < gates; ++gate)
                    sums[gate] = from[gate];
            else
                for (std::size_t gate = 0; gate < gates; ++gate)
                    sums[gate] += from[gate];
            begin += length;
        }
        if (left <= 1) return;
        count -= length;
        const std::uint32_t* ahead = numbers + length;
        for (std::size_t i = 0; i < count; ++i)
            numbers[i] += ahead[i];
        length *= 2;
    }
}

void exchange_rows(const std::uint32_t* HWY_RESTRICT row, const std::uint32_t* HWY_RESTRICT old,
                   std::size_t gates, std::uint32_t* HWY_RESTRICT sums) {
    for (std::size_t gate = 0; gate < gates; ++gate)
        sums[gate] += row[gate] - old[gate];
}

// Loads as many lanes as there are, and zeros for the other lanes.
template <class D>
HWY_INLINE hn::Vec<D> load_some(D d, const hn::TFromD<D>* from, std::size_t count) {
    if (count >= hn::Lanes(d)) return hn::LoadU(d, from);
    HWY_ALIGN hn::TFromD<D> lanes[hn::MaxLanes(D())] = {};
    for (std::size_t i = 0; i < count; ++i)
        lanes[i] = from[i];
    return hn::Load(d, lanes);
}
template <class D, class V>
HWY_INLINE void store_some(D d, V values, hn::TFromD<D>* to, std::size_t count) {
    if (count >= hn::Lanes(d)) return hn::StoreU(values, d, to);
    HWY_ALIGN hn::TFromD<D> lanes[hn::MaxLanes(D())];
    hn::Store(values, d, lanes);
    for (std::size_t i = 0; i < count; ++i)
        to[i] = lanes[i];
}

void features_of_sums(const std::uint32_t* HWY_RESTRICT sums, std::size_t number,
                      const SumFeature& feature, float* HWY_RESTRICT values) {
    const hn::ScalableTag<float> f;
    const hn::RebindToUnsigned<decltype(f)> u;
    const hn::RebindToSigned<decltype(f)> s;
    using Kind = SumFeature::Kind;
    const bool is_root = feature.kind == Kind::root_mean;
    const auto sum_mask = hn::Set(u, BoxSum::most_sum);
    const auto nan = hn::Set(f, std::numeric_limits<float>::quiet_NaN());
    const auto scale = hn::Set(f, feature.scale), offset = hn::Set(f, feature.offset);
    const auto all = hn::Set(f, feature.all), one = hn::Set(f, 1.0F);
    for (std::size_t i = 0; i < number; i += hn::Lanes(f)) {
        const auto bits = load_some(u, sums + i, number - i);
        const auto count = hn::ConvertTo(f, hn::BitCast(s, hn::ShiftRight<BoxSum::sum_bits>(bits)));
        auto value = hn::Div(count, all);
        if (feature.kind != Kind::share) {
            // Divides a sum of nothing by 1, because 0 / 0 would raise a floating-point trap.
            const auto is_none = hn::RebindMask(f, hn::Eq(bits, hn::Zero(u)));
            const auto sum = hn::ConvertTo(f, hn::BitCast(s, hn::And(bits, sum_mask)));
            const auto mean = hn::Div(sum, hn::IfThenElse(is_none, one, count));
            value = hn::Div(is_root ? hn::Sqrt(mean) : hn::Sub(mean, offset), scale);
            if (feature.kind == Kind::magnitude) value = hn::Abs(value);
            value = hn::IfThenElse(is_none, nan, value);
        }
        store_some(f, value, values + i, number - i);
    }
}

void add_entries(const float* HWY_RESTRICT values, std::size_t number, const StepTable& table,
                 float* HWY_RESTRICT totals) {
    // Gathering more than eight entries at once takes longer on some processors.
    const hn::CappedTag<float, 8> f;
    const hn::RebindToSigned<decltype(f)> s;
    const auto first = hn::Set(f, table.first), scale = hn::Set(f, table.steps_per_unit);
    const auto half = hn::Set(f, 0.5F), zero = hn::Zero(f);
    const auto last = hn::Set(f, static_cast<float>(table.last_step));
    const auto beyond = hn::Set(s, table.last_step + 1);
    for (std::size_t i = 0; i < number; i += hn::Lanes(f)) {
        const auto value = load_some(f, values + i, number - i);
        const auto is_missing = hn::IsNaN(value);
        const auto known = hn::IfThenElse(is_missing, first, value);
        const auto step = hn::Add(hn::Mul(hn::Sub(known, first), scale), half);
        const auto place = hn::ConvertTo(s, hn::Max(hn::Min(step, last), zero));
        const auto at = hn::IfThenElse(hn::RebindMask(s, is_missing), beyond, place);
        const auto total = load_some(f, totals + i, number - i);
        store_some(f, hn::Add(total, hn::GatherIndex(f, table.entries, at)), totals + i,
                   number - i);
    }
}

}  // namespace stormcellar::retrieve::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stormcellar::retrieve {

HWY_EXPORT(keep_valid_8);
HWY_EXPORT(keep_valid_16);
HWY_EXPORT(number_codes);
HWY_EXPORT(number_differences);
HWY_EXPORT(sum_windows);
HWY_EXPORT(exchange_rows);
HWY_EXPORT(features_of_sums);
HWY_EXPORT(add_entries);

void keep_valid_codes(const std::uint8_t* codes, std::size_t gates, std::uint16_t first_valid,
                      std::uint16_t* valid) {
    HWY_DYNAMIC_DISPATCH(keep_valid_8)(codes, gates, first_valid, valid);
}
void keep_valid_codes(const std::uint16_t* codes, std::size_t gates, std::uint16_t first_valid,
                      std::uint16_t* valid) {
    HWY_DYNAMIC_DISPATCH(keep_valid_16)(codes, gates, first_valid, valid);
}

void number_codes(const std::uint16_t* codes, std::size_t gates, std::uint32_t most,
                  std::uint32_t* numbers) {
    HWY_DYNAMIC_DISPATCH(number_codes)(codes, gates, most, numbers);
}

void number_differences(const std::uint16_t* codes, const std::uint16_t* others, std::size_t gates,
                        const CodeDifferences& differences, std::uint32_t* numbers) {
    HWY_DYNAMIC_DISPATCH(number_differences)(codes, others, gates, differences, numbers);
}

void sum_windows(std::uint32_t* numbers, std::size_t gates, unsigned window, std::uint32_t* sums) {
    HWY_DYNAMIC_DISPATCH(sum_windows)(numbers, gates, window, sums);
}

void exchange_rows(const std::uint32_t* row, const std::uint32_t* old, std::size_t gates,
                   std::uint32_t* sums) {
    HWY_DYNAMIC_DISPATCH(exchange_rows)(row, old, gates, sums);
}

void features_of_sums(const std::uint32_t* sums, std::size_t count, const SumFeature& feature,
                      float* values) {
    HWY_DYNAMIC_DISPATCH(features_of_sums)(sums, count, feature, values);
}

void add_entries(const float* values, std::size_t count, const StepTable& table, float* totals) {
    HWY_DYNAMIC_DISPATCH(add_entries)(values, count, table, totals);
}

}  // namespace stormcellar::retrieve
#endif
