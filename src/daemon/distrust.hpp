// A spool that comes from a backup does not know what was printed after it was made. Printing on from it would print
// those records twice, so everything that it does not know as printed is put in doubt, and an operator says from the
// products how far each job came (cli/operator_word.hpp).
#pragma once

#include "base/failure.hpp"
#include "spool/spool.hpp"

#include <string>
#include <vector>

namespace linefeed::daemon {

/// A job of which records are in doubt now.
struct DistrustedJob {
    spool::Job job;
    std::vector<RecordRange> in_doubt; ///< all of them, also those that were before; ascending, not empty
};

/// Puts every record in doubt that may have been printed unknown to the spool, which is each that is not printed and
/// not skipped, by the word of `who`. Durable at return; all the jobs that have records in doubt then, oldest first.
/// Done twice it changes nothing more. What fails half-way is done again as a whole.
[[nodiscard]] Result<std::vector<DistrustedJob>> distrust(spool::Spool& spool, const std::string& who,
                                                          const std::string& why);

} // namespace linefeed::daemon
