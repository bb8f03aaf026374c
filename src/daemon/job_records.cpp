#include "daemon/job_records.hpp"

#include "daemon/record_text.hpp"

#include <algorithm>

namespace linefeed::daemon {

Result<void> for_each_record(spool::Spool& spool, const spool::Job& job, std::span<const RecordRange> ranges,
                             const std::function<bool(DoubtView::Record)>& take) {
    const RecordFormat format = record_format(job);
    RecordPage page;
    for (const RecordRange& range : ranges) {
        for (std::uint64_t i = 0; i < range.count().value(); ++i) {
            const RecordNumber number = range.first() + RecordCount{i};
            if (page.ends.empty() || !page.range().contains(number)) {
                auto read = spool.read_page(job.id, number);
                if (!read) {
                    return read.error();
                }
                page = std::move(*read);
            }
            if (!take({number, record_fields(page, number, format)})) {
                return {};
            }
        }
    }
    return {};
}

Result<std::vector<DoubtView::Record>> records_of(spool::Spool& spool, const spool::Job& job,
                                                  std::span<const RecordRange> ranges, std::size_t limit) {
    std::vector<RecordRange> there;
    for (const RecordRange& range : ranges) {
        if (!range.empty() && !job.records.empty()) {
            there.push_back(RecordRange::closed(std::max(range.first(), job.records.first()),
                                                std::min(range.last(), job.records.last())));
        }
    }
    std::vector<DoubtView::Record> records;
    const auto take = [&](DoubtView::Record record) {
        records.push_back(std::move(record));
        return records.size() < limit;
    };
    auto read = limit == 0 ? Result<void>{} : for_each_record(spool, job, there, take);
    return read ? Result<std::vector<DoubtView::Record>>{std::move(records)} : read.error();
}

} // namespace linefeed::daemon
