/* source.c - what the readers of files share. A place is an offset until it is needed: lines and
 * columns are counted only when there is an error to tell. */
#include "formats/source.h"

#include "base/number.h"

#include <string.h>

msr_status msri_source_fail(const msri_source *source, size_t at, msr_error *err,
                            const char *format, ...) {
  char text[MSR_MESSAGE_SIZE];
  size_t line = 1, column = 1;
  for (size_t i = 0; i < at; i++) {
    const bool ends = source->bytes[i] == '\n', continues = (source->bytes[i] & 0xC0) == 0x80;
    line += ends;
    column = ends ? 1 : column + !continues;
  }
  va_list arguments;
  va_start(arguments, format);
  msri_vformat(text, sizeof text, format, arguments);
  va_end(arguments);
  return msri_fail(err, MSR_EINPUT, "%s:%zu:%zu: %s", source->name, line, column, text);
}

/* Bytes of the printable UTF-8 character at p, which has at most `size`; 0: there is none. */
static size_t character(const unsigned char *p, size_t size) {
  static const uint32_t least[] = {0, 0x20, 0xA0, 0x800, 0x10000};
  const size_t n = *p < 0x80 ? 1 : *p < 0xC0 ? 0 : *p < 0xE0 ? 2 : *p < 0xF0 ? 3 : 4;
  if (n == 0 || n > size) return 0;
  uint32_t code = n == 1 ? *p : *p & (0x7Fu >> n);
  for (size_t i = 1; i < n; i++) {
    if ((p[i] & 0xC0) != 0x80) return 0;
    code = code << 6 | (p[i] & 0x3Fu);
  }
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code >= least[n] && code != 0x7F && !surrogate && code <= 0x10FFFF && *p < 0xF8 ? n : 0;
}

const char *msri_source_quote(const msri_source *source, size_t at, size_t size,
                              char text[MSRI_QUOTE_SIZE]) {
  enum { ROOM = MSRI_QUOTE_SIZE - sizeof "...'" }; // for what is quoted and the first quote
  const unsigned char *p = source->bytes + at;
  size_t length = 0;
  text[length++] = '\'';
  while (size > 0) {
    const size_t n = character(p, size), used = n ? n : 1;
    if (length + (n ? n : sizeof "\\xNN" - 1) > ROOM) break;
    if (n) memcpy(text + length, p, n);
    if (!n) msri_format(text + length, sizeof "\\xNN", "\\x%02X", *p);
    length += n ? n : sizeof "\\xNN" - 1;
    p += used;
    size -= used;
  }
  strcpy(text + length, size > 0 ? "...'" : "'");
  return text;
}

static const msri_kind kinds[] = {
    {"P1", "a PBM picture (P1)", "convert it: ppmtoppm < x.pbm > x.ppm"},
    {"P2", "a PGM picture (P2)", "convert it: ppmtoppm < x.pgm > x.ppm"},
    {"P3", "a PPM picture (P3)", NULL},
    {"P4", "a PBM picture (P4)", "convert it: ppmtoppm < x.pbm > x.ppm"},
    {"P5", "a PGM picture (P5)", "convert it: ppmtoppm < x.pgm > x.ppm"},
    {"P6", "a PPM picture (P6)", NULL},
    {"P7", "a PAM picture (P7)", "convert it: pamtopnm x.pam > x.ppm"},
    {"\x89PNG", "a PNG picture", "convert it: pngtopnm x.png > x.ppm"},
    {"\xFF\xD8\xFF", "a JPEG picture",
     "convert it: jpegtopnm x.jpg > x.ppm (a PNG would be sharper)"},
    {"GIF8", "a GIF picture", "convert it: giftopnm x.gif > x.ppm"},
    {"BM", "a BMP picture", "convert it: bmptopnm x.bmp > x.ppm"},
    {"II*", "a TIFF picture", "convert it: tifftopnm x.tif > x.ppm"},
    {"MM", "a TIFF picture", "convert it: tifftopnm x.tif > x.ppm"},
    {"gimp xcf", "a GIMP picture", "export it from GIMP as PPM"},
    {"<svg", "an SVG picture", "export it as PNG, then: pngtopnm x.png > x.ppm"},
    {"<?xml", "an XML file", "export it as PNG, then: pngtopnm x.png > x.ppm"},
    {"%PDF", "a PDF document", "give a picture"},
    {"\x1F\x8B", "a gzip archive", "unpack it: gunzip x.ppm.gz"},
    {"PK\x03\x04", "a zip archive", "unpack it: unzip x.zip"},
    {"\xFF\xFE", "UTF-16 text", "give a picture"},
    {"\xFE\xFF", "UTF-16 text", "give a picture"},
    {"DT", "a conf", "give it as the conf"},
};

const msri_kind *msri_source_kind(const msri_source *source) {
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    const size_t n = strlen(kinds[i].magic);
    if (source->size >= n && memcmp(source->bytes, kinds[i].magic, n) == 0) return &kinds[i];
  }
  return NULL;
}
