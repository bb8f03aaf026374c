// Where the records of one job lie among the places of a run, which may print two jobs one behind the other
// (feeder/numbering.hpp).
#pragma once

#include "base/record_number.hpp"

#include <algorithm>

namespace linefeed::store {

/// Consecutive places. As it is constructed, the places are the numbers of the job.
struct JobPlaces {
    RecordNumber first;  ///< place
    RecordNumber number; ///< of the record there, in its job
    RecordNumber last = RecordNumber::max();

    /// Precondition: not so far before the first that there is no place.
    [[nodiscard]] RecordNumber place_of(RecordNumber record) const {
        return record < number ? RecordNumber{first.value() - (number.value() - record.value())}
                               : first + (record - number);
    }
    /// The job's last record at or before `place`; the number before its first if there is none.
    [[nodiscard]] RecordNumber through(RecordNumber place) const {
        return place < first ? number.previous() : number + (std::min(place, last) - first);
    }
    /// The job's records at these places. May be empty.
    [[nodiscard]] RecordRange records(RecordRange places) const {
        if (places.empty() || places.last() < first || last < places.first()) {
            return {};
        }
        return RecordRange::closed(through(std::max(places.first(), first)), through(places.last()));
    }
    /// The record at `place`; 0 = it is not of this job.
    [[nodiscard]] RecordNumber record_at(RecordNumber place) const {
        return first <= place && place <= last ? through(place) : RecordNumber{};
    }
};

} // namespace linefeed::store
