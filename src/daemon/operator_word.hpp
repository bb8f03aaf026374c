// Records in doubt are settled by an operator, who has looked at the products. What he says becomes ledger rows with
// his name; no default ever guesses, and a word that the evidence does not bear is refused.
#pragma once

#include "base/failure.hpp"
#include "daemon/doubt_evidence.hpp"
#include "spool/spool.hpp"

#include <optional>
#include <string>
#include <vector>

namespace linefeed::daemon {

/// `--in-doubt`.
enum class InDoubtPolicy {
    ask,     ///< on a terminal, ask; otherwise end with exit code 6
    skip,    ///< leave them out: not printed again
    reprint, ///< print them (again)
};

/// At most one of the three is given.
struct OperatorWord {
    InDoubtPolicy policy = InDoubtPolicy::ask;
    /// `--last-printed`: number or text of the record on the last product; empty = not said.
    std::string last_printed{};
    /// `--printed`: the records in doubt that are on products, "N-M,N" or "none"; absent = not said.
    std::optional<std::string> printed{};

    [[nodiscard]] bool given() const { return policy != InDoubtPolicy::ask || !last_printed.empty() || printed; }
};

/// The rows that settle every record in doubt of the job by the word of `who`. Reads each of those records at most
/// once: that may be millions. FailureKind::usage, with what to say instead, if
/// - last_printed is neither one of the records in doubt nor the one before the first of them, or the text of several,
/// - last_printed is said although records may have been left out before it, or the total print counter contradicts it,
/// - printed names a record twice, or one that is not in doubt.
[[nodiscard]] Result<std::vector<spool::LedgerEntry>>
rows_by_operator(spool::Spool& spool, const spool::Job& job, const OperatorWord& word, const std::string& who);

/// Appends them, durable at return; nothing is written if it fails.
[[nodiscard]] Result<void> settle_by_operator(spool::Spool& spool, const spool::Job& job, const OperatorWord& word,
                                              const std::string& who);

} // namespace linefeed::daemon
