#include "spool/ledger.hpp"

#include "spool/checksum.hpp"
#include "spool/ledger_codec.hpp"

#include <array>
#include <utility>

namespace linefeed::spool {

namespace {

constexpr std::array<std::pair<LedgerKind, std::string_view>, 9> kind_names{{
    {LedgerKind::run_started, "run_started"},
    {LedgerKind::intent, "intent"},
    {LedgerKind::printed, "printed"},
    {LedgerKind::unused, "unused"},
    {LedgerKind::in_doubt, "in_doubt"},
    {LedgerKind::skipped, "skipped"},
    {LedgerKind::released, "released"},
    {LedgerKind::reprint, "reprint"},
    {LedgerKind::run_ended, "run_ended"},
}};

constexpr std::array<std::pair<RecordState, std::string_view>, 7> state_names{{
    {RecordState::fresh, "fresh"},
    {RecordState::open, "open"},
    {RecordState::printed, "printed"},
    {RecordState::unused, "unused"},
    {RecordState::in_doubt, "in_doubt"},
    {RecordState::skipped, "skipped"},
    {RecordState::released, "released"},
}};

template <typename Table, typename Value>
std::string_view name_of(const Table& table, Value value) {
    for (const auto& [candidate, name] : table) {
        if (candidate == value) {
            return name;
        }
    }
    assertion_failed("value of the enum", __FILE__, __LINE__);
}

template <typename Value, typename Table>
std::optional<Value> value_of(const Table& table, std::string_view name) {
    for (const auto& [value, candidate] : table) {
        if (candidate == name) {
            return value;
        }
    }
    return std::nullopt;
}

} // namespace

std::string_view to_string(LedgerKind kind) {
    return name_of(kind_names, kind);
}

std::string_view to_string(RecordState state) {
    return name_of(state_names, state);
}

std::optional<LedgerKind> ledger_kind_from_name(std::string_view name) {
    return value_of<LedgerKind>(kind_names, name);
}

std::optional<RecordState> record_state_from_name(std::string_view name) {
    return value_of<RecordState>(state_names, name);
}

std::string ledger_hash(std::string_view previous_hash, std::int64_t sequence, JobId job, const LedgerEntry& entry,
                        std::int64_t time_ns) {
    // One field a line, the only free text last and with its length: no two rows give the same text. What is hashed can
    // be rebuilt with printf and sha256sum.
    std::string text{previous_hash};
    const auto add_number = [&text](auto value) { text.append(1, '\n').append(std::to_string(value)); };
    add_number(sequence);
    add_number(static_cast<std::int64_t>(job));
    text.append(1, '\n').append(to_string(entry.kind));
    add_number(static_cast<std::int64_t>(entry.run));
    add_number(entry.range.first().value());
    add_number(entry.range.count().value());
    add_number(time_ns);
    add_number(entry.evidence.size());
    text.append(1, '\n').append(entry.evidence);
    Sha256 sha;
    sha.update(text);
    const Sha256Digest digest = sha.finish();
    return to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

} // namespace linefeed::spool
