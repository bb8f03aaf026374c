#include "feeder/actions.hpp"

namespace linefeed::feeder {

namespace {

struct Printer {
    std::ostream& out;

    void operator()(std::monostate) const { out << "nothing"; }
    void operator()(const Inquire& inquire) const { out << '?' << code(inquire.what); }
    void operator()(const Command& command) const { out << '!' << code(command.what); }
    void operator()(const SetStopAt& stop) const { out << "=CM " << stop.number; }
    void operator()(const SendRecords& send) const { out << "=MR " << send.range; }
    void operator()(const SendEndMarker& marker) const { out << "end marker " << marker.number; }
    void operator()(const Settle& settle) const {
        out << "settle " << (settle.earlier_run ? "the earlier run" : "this run");
        if (settle.provisional) {
            out << " so far: printed " << settle.verdict.printed << " by " << to_string(settle.verdict.basis);
        } else {
            out << ": " << settle.verdict;
        }
    }
    void operator()(const BeginRun& begin) const {
        out << (begin.follower ? "begin the follower's run" : "begin run") << ", last printed before "
            << begin.last_printed_before;
    }
    void operator()(const AdoptRun& adopt) const {
        out << "adopt run, printed through " << adopt.printed_through << ", sent through " << adopt.sent_through;
    }
    void operator()(const AskIntent& intent) const { out << "intent through " << intent.through; }
    void operator()(const ConfirmPrinted& confirm) const { out << "printed through " << confirm.through; }
    void operator()(const Notice& notice) const { out << "notice: " << describe(notice); }
    void operator()(const End& end) const { out << "end: " << end.outcome; }
};

} // namespace

std::ostream& operator<<(std::ostream& out, const Action& action) {
    std::visit(Printer{out}, action);
    return out;
}

std::string describe(const Notice& notice) {
    switch (notice.code) {
    case NoticeCode::printing_started:
        return "printing";
    case NoticeCode::follower_printing:
        return "the next job follows without a stop";
    case NoticeCode::stop_point_ignored:
        return "the printer does not keep the stop point (=CM): a blank end marker follows the last record, "
               "and the product behind the last one may come out blank";
    case NoticeCode::error_acknowledged:
        return "acknowledged " + protocol::describe(notice.error);
    case NoticeCode::printer_warning:
        return "the printer reports " + protocol::describe(notice.error);
    case NoticeCode::taken_over:
        return "the printer is still printing: taken over without a stop";
    case NoticeCode::found_printing:
        return "the printer was still printing records of the earlier run: it is stopped to learn where it is";
    case NoticeCode::nozzle_opening:
        return "opening the nozzle: this takes 30 to 60 s";
    case NoticeCode::supply_low:
        return "the printer runs empty soon: the records are read more slowly than the line prints them";
    case NoticeCode::entries_differ:
        return "the printer reports another number of FIFO entries than was sent";
    }
    assertion_failed("NoticeCode", __FILE__, __LINE__);
}

} // namespace linefeed::feeder
