// Records in doubt are settled by an operator, who has looked at the last product. What he says becomes ledger rows
// with his name; no default ever guesses.
#pragma once

#include "base/failure.hpp"
#include "spool/spool.hpp"

#include <optional>
#include <string>

namespace linefeed::cli {

/// `--in-doubt`.
enum class InDoubtPolicy {
    ask,     ///< on a terminal, ask; otherwise end with exit code 6
    skip,    ///< leave them out: not printed again
    reprint, ///< print them (again)
};

struct OperatorWord {
    InDoubtPolicy policy = InDoubtPolicy::ask;
    /// `--last-printed`: number or text of the record on the last product.
    std::string last_printed;

    [[nodiscard]] bool given() const { return policy != InDoubtPolicy::ask || !last_printed.empty(); }
};

/// Settles every record in doubt of the job, durable at return. FailureKind::usage if last_printed does not fit: it
/// must be one of the records in doubt, or the one before the first of them; a text must be that of exactly one.
[[nodiscard]] Result<void> settle_by_operator(spool::Spool& spool, const spool::Job& job, const OperatorWord& word);

} // namespace linefeed::cli
