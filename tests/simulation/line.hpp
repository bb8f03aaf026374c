// The production line: the printer at the address (and another one that may take its place), the belt with its
// products, the operator's panel, and other programs that talk to the printer.
#pragma once

#include "context.hpp"
#include "judge.hpp"
#include "protocol/frame_decoder.hpp"
#include "random.hpp"
#include "simulator/printer_model.hpp"
#include "wire.hpp"

#include <array>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace linefeed::simulation {

class Line {
public:
    Line(Context& context, Judge& judge, Wire& wire, Random random);

    /// Asked at an underrun, or when a product gets no record: is there an excuse for it?
    std::function<bool()> underrun_is_explained;

    void receive(std::uint64_t connection, std::string_view bytes);
    void disconnected(std::uint64_t connection);

    /// When the next product reaches the sensor; Instant::max() = the belt stands still.
    [[nodiscard]] Instant product_due() const { return product_due_; }
    void product();
    /// An event of kind belt_changes.
    void change_belt();
    void pause_belt(Duration duration);

    /// The printer, brought up to now.
    [[nodiscard]] const simulator::PrinterModel& look();
    /// Something at the panel or to the machine; what follows from it is carried out.
    template <typename Deed>
    void act(Deed&& deed) {
        deed(*printer_, context_.now);
        carry_out();
    }
    /// What of the host may be about to reach the printer.
    enum class Moment {
        record,
        record_while_printing,
        count_over_records, ///< `?CC`, the end of a look at a printer that stands, with records in its FIFO
    };
    /// Calls `deed` at the next such moment, or `skipped` moments later; once, and not behind `until`.
    void at(Moment moment, std::uint64_t skipped, Instant until, std::function<void()> deed);
    /// Another client sends a frame such as "^0?SM"; the answer goes to it.
    void other_client(std::string_view frame);
    /// The same, but the frame changes what is printed.
    void interfere(std::string_view frame);
    /// Another client has interfered, and the printer has not been stopped since.
    [[nodiscard]] bool others_interfere() const { return others_interfere_; }
    /// Another host prints `count` records numbered from `first`.
    void another_job(std::uint64_t first, std::uint64_t count);
    /// Takes the printer away and puts another there (or the first one back).
    void exchange_printer();

private:
    void about_to_take(const protocol::Frame& frame);
    [[nodiscard]] bool is_moment(const protocol::Frame& frame) const;
    [[nodiscard]] std::unique_ptr<simulator::PrinterModel> sister_printer();
    void carry_out();
    void carry_out(simulator::Effect& effect);
    void move_belt();
    [[nodiscard]] Duration step();

    static constexpr std::uint64_t other_client_id = 1'000'000'000;

    Context& context_;
    Judge& judge_;
    Wire& wire_;
    Random random_;
    std::array<std::unique_ptr<simulator::PrinterModel>, 2> printers_;
    std::size_t at_address_ = 0;
    simulator::PrinterModel* printer_;
    std::vector<simulator::Effect> effects_;
    struct Client {
        std::uint64_t connection = 0;
        protocol::FrameDecoder decoder;
    };
    std::vector<std::unique_ptr<Client>> clients_;
    Instant product_due_ = Instant::max();
    Instant belt_stands_until_{};
    bool fast_ = false;
    bool others_interfere_ = false;
    bool next_is_intact_ = false;  ///< the record that lies ready carries its own text; with CRC32 only
    bool started_empty_ = false;   ///< by a person, with nothing in the FIFO
    bool started_by_host_ = false; ///< or by somebody who does not ask whether records are there
    // at()
    std::function<void()> deed_;
    Moment deed_at_ = Moment::record;
    std::uint64_t moments_skipped_ = 0;
    Instant deed_until_{};
    Instant printing_since_{};
};

} // namespace linefeed::simulation
