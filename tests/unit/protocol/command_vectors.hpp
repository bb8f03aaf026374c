// Frames of every command, as the manual writes them: what is read from each must come out as the same bytes again.
#pragma once

#include "protocol/command_table.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace linefeed::protocol {

/// At least one for each row but the actions and inquiries, whose frames are their codes. Those of section 8 have
/// escapes.
inline constexpr auto command_vectors = std::to_array<std::string_view>({
    "^0=AC2\t1\t0\t17\t3\t2\t1410065407\r",
    "^0=CC17\t500\t123456\r",
    "^0=CM100000\r",
    "^0=CO3\t1\r",
    "^0=CO0\t1\r",
    "^0=CO0\t0\r",
    "^0=CP2\t1\t4\r",
    "^0=CP3\t2\t9999\r",
    "^0=DL2015\t10\t1\t26\t7\t45\t23\r",
    "^0=DS24576\r",
    "^0=EL33\t34\t2\t24-05-06 07:08:09/00005043\t24-12-31 23:59:59/00010202\r",
    "^0=ETHallo\r",
    "^0=ET(8 3 FF81FF)\r",
    "^0=ETHallo(8 3 FF81FF)\r",
    "^0=ETHallo\t(8 3 FF81FF)\\\\\\^\r",
    "^0=EV1\t1\t1\t24-05-06 07:08:09/30/2/11/40/2400/1000/7100/6\r",
    "^0=EX300\t131585\t1800\t1\t\t1\t0\t0\t0\r",
    "^0=FC3957421711\r",
    "^0=FL2048\r",
    "^0=GWPPABAC\r",
    "^0=HS7100\t2400\t35\t1000\t0\tx\r",
    "^0=IC0\t1\t3\t4\t12\t10\r",
    "^0=JLFFSDISK\\\\JOBS\\\\TESTPRINT.JOB\r",
    "^0=MC1\t2\t0\t0\t0\t7100\t2400\t0\t-3\t66\t70000\t600\t2200\r",
    "^0=MR22118\tMiss\tJane\tMiller\r",
    "^0=MR0\ttext1\t{ho2r3}\r",
    "^0=MR0\ttext2\ttext3\t{r21}\r",
    "^0=MR0\t111\t(8 3 FF81FF)\r",
    "^0=MR0\t(12 4 FF0F01080108FF0F)\r",
    "^0=MR1\t00480065006C006C006F00200057006F0072006C0064\r",
    "^0=MR17\tMiss\tJane\tMiller\t{ho2}\r",
    "^0=MS1\t1\t0\t1\t0\t0\t1\t0\t2\t1\t0\r",
    "^0=NR3957421711\r",
    "^0=NR3560773416\r",
    "^0=OC1\t2\t3\t4\t5\t6\t12\t13\r",
    "^0=PR2\t31000\r",
    "^0=RC2\t9999999999\r",
    "^0=RS2\t5\t0\t0\t9\t1\r",
    "^0=RS2\t6\t0\t0\t9\t0\r",
    "^0=RS2\t5\t-1711274809\t0\t9\t0\r",
    "^0=RS2\t6\t0\t0\t0\r",
    "^0=RS2\t6\t-1711274809\t0\t9\t0\r",
    "^0=SC2000\t365\r",
    "^0=SH1234\t1000\t1570672640\r",
    "^0=SL19\t12\t0\t0\r",
    "^0=SM256\t0\t0\t0\t1\r",
    "^0=SM256\t0\t0\t100000\t1\r",
    "^0=SM256\t255\t0\t100000\t1\r",
    "^0=SM256\t198\t22175\t100000\t1\r",
    "^0=SM256\t249\t22219\t100000\t1\r",
    "^0=SM256\t249\t99750\t100000\t1\r",
    "^0=SM256\t127\t99872\t100000\t1\r",
    "^0=SM256\t49\t99950\t100000\t1\r",
    "^0=SM256\t3\t99996\t100000\t1\r",
    "^0=SM256\t0\t100000\t0\t1\r",
    "^0=SM256\t0\t3\t0\t1\t21\r",
    "^0=SM256\t253\t22119\t100000\t1\r",
    "^0=SW120\r",
    "^0=VSf\tr\ts\tfe\tk\tJET3up\tl\tfo\tV62.0.7.0\tt\t4711\r",
    "^0*BEGINLJSCRIPT\r",
    "^0*ENDLJSCRIPT\r",
    "^0*OBJ (x) \\^\\\\\r",
    "^0$RDFFSDISK\\\\Jobs\r",
    "^0$RDFFSDISK\\\\Jobs*\r",
    "^0$DI1\t00\r",
    "^0$DI1\t01\t!Jobs\r",
    "^0$DI1\t06\tCOUNTER.JOB\tDATE.JOB\tDM.JOB\tTestprint.job\tLINIE.job\tLJ24 Test.job\r",
    "^0$DI1\t02\t!Jobs\tLJ24 Test.job\r",
    "^0$DFFFSDISK\\\\Jobs\\\\a.job\r",
    "^0$RFFFSDISK\\\\Jobs\\\\MyJob1.job\r",
    "^0$FHFFSDISK\\\\Jobs\\\\MyJob1.job\t2\r",
    "^0$FT2\t131\tIBAC\r",
    "^0$FA2\t1\r",
});

/// The frames of a row; none if there is none here.
inline std::vector<std::string> vectors_of(const Command& row) {
    const std::string head = std::string{"^0"} + static_cast<char>(row.group) + std::string{row.code};
    if (row.group == Group::action || row.group == Group::inquiry) {
        return {head + "\r"};
    }
    std::vector<std::string> frames;
    for (const std::string_view frame : command_vectors) {
        if (row.code.empty() ? frame.starts_with("^0*OBJ") : frame.starts_with(head)) {
            frames.emplace_back(frame);
        }
    }
    return frames;
}

} // namespace linefeed::protocol
