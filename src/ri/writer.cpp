#include "ri/writer.h"
#include "ri/encoder.h"
#include "ri/requests/request.h"
#include <cmath>
#include <fast_float/fast_float.h>
#include <fmt/format.h>

namespace alpenglow::ri {
namespace {

using Precision = RibEncoder::Precision;

/// The number that the reader makes of this handle again; NaN when it is none.
double handleNumber(const std::string& text) {
    double d = NAN;
    const char* end = text.data() + text.size();
    if (text.empty() || fast_float::from_chars(text.data(), end, d).ptr != end || !std::isfinite(d)) return NAN;
    return fmt::format("{}", d) == text ? d : NAN;
}

void argument(RibEncoder& to, const ArgSpec& a, const Argument& x) {
    using Form = ArgSpec::Form;
    constexpr size_t kBare = 4; // numbers of a quadric or a rotation; more are written in brackets
    if (a.form == Form::Handle) {
        const double d = handleNumber(x.strings[0]);
        if (std::isnan(d)) to.text(x.strings[0]);
        else to.bare({&d, 1}, Precision::Exact);
    } else if (a.form == Form::String && a.array) {
        to.texts(x.strings);
    } else if (!x.strings.empty()) { // Basis, too
        to.text(x.strings[0]);
    } else if (a.array || x.numbers.size() > kBare || x.numbers.size() == size_t(a.otherCount)) {
        to.array(x.numbers, Precision::Exact);
    } else {
        to.bare(x.numbers, Precision::Exact);
    }
}

} // namespace

bool RibEncoder::handOn(bool last) {
    if (finished_) return !failed_;
    send();
    if (!failed_ && !(last ? to_->finish() : to_->flush())) failed_ = true;
    finished_ = last;
    return !failed_;
}

void RibEncoder::send() {
    if (!failed_ && !finished_ && !buffer_.empty() && !to_->write(buffer_)) failed_ = true;
    sent_ += buffer_.size();
    buffer_.clear();
}

RibWriter::RibWriter(std::unique_ptr<ByteSink> to, RibFormat format) {
    if (format.gzip) to = deflating(std::move(to));
    encoder_ = format.binary ? binaryEncoder(std::move(to)) : asciiEncoder(std::move(to), format);
}

RibWriter::~RibWriter() {
    if (encoder_) encoder_->handOn(true);
}

void RibWriter::write(const Call& call) {
    RibEncoder& to = *encoder_;
    to.begin(call.request->name);
    for (size_t i = 0; i < call.arguments.size(); ++i)
        if (call.arguments[i].given) argument(to, call.request->args[i], call.arguments[i]);
    for (const RawParam& p : call.params) {
        to.text(p.token);
        value(p.value, false);
    }
    to.end();
    if (call.request->name == "ColorSamples") to.parameters = Precision::Exact; // colours are multiplied in double
}

void RibWriter::write(const std::string& name, const std::vector<Value>& values) {
    encoder_->begin(name);
    for (const Value& v : values) value(v, true);
    encoder_->end();
}

void RibWriter::value(const Value& v, bool exact) {
    RibEncoder& to = *encoder_;
    const Precision precision = exact ? Precision::Exact : to.parameters;
    if (v.kind == Value::Kind::Strings) {
        if (!v.array && v.strings.size() == 1) to.text(v.strings[0]);
        else to.texts(v.strings);
    } else if (v.array || v.numbers.empty()) {
        to.array(v.numbers, precision);
    } else {
        to.bare(v.numbers, precision);
    }
}

void RibWriter::comments(std::string_view mark, std::string_view text) {
    for (;;) {
        const size_t n = text.find_first_of("\r\n");
        encoder_->line(fmt::format("{}{}", mark, text.substr(0, n)));
        if (n == text.npos) return;
        text.remove_prefix(n + (text.substr(n, 2) == "\r\n" ? 2 : 1));
    }
}

void RibWriter::comment(std::string_view text) { comments("#", text); }
void RibWriter::structure(std::string_view text) { comments("##", text); }

void RibWriter::verbatim(std::string_view text) {
    while (text.ends_with('\n')) text.remove_suffix(1);
    if (!text.empty()) encoder_->line(text);
}

bool RibWriter::flush() { return encoder_->handOn(false); }

bool RibWriter::finish() { return encoder_->handOn(true); }

const std::string& RibWriter::failure() const { return encoder_->failure(); }
uint64_t RibWriter::bytes() const { return encoder_->bytes(); }

} // namespace alpenglow::ri
