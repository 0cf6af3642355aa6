#include "web/http/answer_budget.h"

#include <algorithm>
#include <set>

namespace stormcellar::web {
namespace {

// The object that a piece keeps in memory, with all of its bytes; no bytes: it is not counted.
struct HeldObject {
    const void* object = nullptr;
    std::uint64_t bytes = 0;
};
HeldObject object_of(const Piece& piece) {
    HeldObject held;
    if (const auto* text = std::get_if<Text>(&piece)) {
        held = {text->get(), (*text)->size()};
    } else if (const auto* slice = std::get_if<FileSlice>(&piece)) {
        held = {slice->file.get(), slice->memory_bytes};
    }
    return held.bytes < least_counted_bytes ? HeldObject{} : held;
}

bool is_counted(const Pieces& pieces) {
    return std::ranges::any_of(pieces,
                               [](const Piece& piece) { return object_of(piece).bytes > 0; });
}

}  // namespace

std::uint64_t AnswerBudget::Holder::bytes_with(const Pieces& pieces) const {
    std::uint64_t sum = bytes;
    std::set<const void*> fresh;
    for (const Piece& piece : pieces) {
        const HeldObject held = object_of(piece);
        if (held.bytes > 0 && !uses.contains(held.object) && fresh.insert(held.object).second)
            sum += held.bytes;
    }
    return sum;
}

void AnswerBudget::Holder::add(const Pieces& pieces) {
    for (const Piece& piece : pieces) {
        const HeldObject held = object_of(piece);
        if (held.bytes > 0 && ++uses[held.object] == 1) bytes += held.bytes;
    }
}

void AnswerBudget::Holder::remove(const Pieces& pieces) {
    for (const Piece& piece : pieces) {
        const HeldObject held = object_of(piece);
        const auto use = uses.find(held.object);
        if (held.bytes == 0 || use == uses.end() || --use->second > 0) continue;
        uses.erase(use);
        bytes -= held.bytes;
    }
}

bool AnswerBudget::Holder::has_room(const Pieces& pieces, std::uint64_t most) const {
    const std::uint64_t with = bytes_with(pieces);
    return with <= most || with == bytes || bytes == 0;
}

bool AnswerBudget::take(const std::string& client, const Pieces& pieces) {
    if (!is_counted(pieces)) return true;
    const std::scoped_lock lock(mutex_);
    const auto theirs = by_client_.try_emplace(client).first;
    const bool has_room =
        all_.has_room(pieces, most_bytes_) && theirs->second.has_room(pieces, most_bytes_ / 2);
    if (has_room) {
        all_.add(pieces);
        theirs->second.add(pieces);
    } else if (theirs->second.uses.empty()) {
        by_client_.erase(theirs);
    }
    return has_room;
}

void AnswerBudget::give_back(const std::string& client, const Pieces& pieces) {
    if (!is_counted(pieces)) return;
    const std::scoped_lock lock(mutex_);
    const auto found = by_client_.find(client);
    if (found == by_client_.end()) return;
    all_.remove(pieces);
    found->second.remove(pieces);
    if (found->second.uses.empty()) by_client_.erase(found);
}

std::uint64_t AnswerBudget::bytes() const {
    const std::scoped_lock lock(mutex_);
    return all_.bytes;
}

}  // namespace stormcellar::web
