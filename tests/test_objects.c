/* test_objects.c - objects of pictures against a flood from pixel to pixel; their rows and pieces
 * hold each mass once. Allocations fail in turn.
 *
 * link: --wrap=malloc --wrap=calloc --wrap=realloc */
#include "plan/objects.h"

#include "alloc.h"
#include "shapes.h"

/* ---- A flood */

typedef struct flood {
  size_t w, h, n;
  int neighbours;
  size_t *object; /* [w h]: its number in reading order; SIZE_MAX: no mass, or not yet known */
  size_t *mass;   /* [w h] */
} flood;

static bool is_mass(const msr_picture *picture, size_t p) {
  return memcmp(picture->rgb + 3 * p, rgb_of('o'), 3) == 0;
}

static void pour(flood *f, const msr_picture *picture, size_t from) {
  size_t *stack = zeroed(9 * f->w * f->h, sizeof *stack), n = 0;
  stack[n++] = from;
  while (n > 0) {
    const size_t p = stack[--n], c = p % f->w, r = p / f->w;
    if (f->object[p] != SIZE_MAX || !is_mass(picture, p)) continue;
    f->object[p] = f->n;
    for (int dr = -1; dr <= 1; dr++)
      for (int dc = -1; dc <= 1; dc++) {
        if (f->neighbours == 4 && dr != 0 && dc != 0) continue;
        const size_t column = c + (size_t)dc, row = r + (size_t)dr;
        if (column < f->w && row < f->h) stack[n++] = row * f->w + column;
      }
  }
  free(stack);
}

static flood flood_of(const msr_picture *picture, int neighbours) {
  const size_t pixels = picture->width * picture->height;
  flood f = {picture->width,
             picture->height,
             0,
             neighbours,
             zeroed(pixels, sizeof(size_t)),
             zeroed(pixels, sizeof(size_t))};
  memset(f.object, 0xff, pixels * sizeof *f.object);
  size_t masses = 0;
  for (size_t p = 0; p < pixels; p++) {
    if (!is_mass(picture, p)) continue;
    f.mass[p] = masses++;
    if (f.object[p] != SIZE_MAX) continue;
    pour(&f, picture, p);
    f.n++;
  }
  return f;
}

/* ---- What is due */

typedef struct box {
  size_t top, bottom, left, right, masses; /* inclusive */
} box;

static box box_of(const flood *f, size_t object) {
  box b = {SIZE_MAX, 0, SIZE_MAX, 0, 0};
  for (size_t p = 0; p < f->w * f->h; p++) {
    if (f->object[p] != object) continue;
    const size_t c = p % f->w, r = p / f->w;
    if (r < b.top) b.top = r;
    if (c < b.left) b.left = c;
    if (c > b.right) b.right = c;
    b.bottom = r;
    b.masses++;
  }
  return b;
}

/* A row's pieces are as long as they can be, in order, and hold the row's masses, all of them. */
static void check_row(const msri_objects *o, const flood *f, size_t object, const box *b,
                      size_t r) {
  const size_t row = o->object[object].row + r - b->top;
  size_t s = o->row[row];
  assert_true(s < o->row[row + 1]);
  for (size_t c = b->left; c <= b->right; c++) {
    const size_t p = r * f->w + c;
    if (f->object[p] != object) continue;
    assert_true(s < o->row[row + 1]);
    const msri_piece *piece = &o->piece[s++];
    assert_int_equal(piece->column, c - b->left);
    assert_int_equal(piece->first, f->mass[p]);
    size_t end = c;
    while (end <= b->right && f->object[r * f->w + end] == object) end++;
    assert_int_equal(piece->count, end - c);
    c = end;
  }
  assert_int_equal(s, o->row[row + 1]);
}

static void check_object(const msri_objects *o, const flood *f, size_t object) {
  const msri_object *is = &o->object[object];
  const box b = box_of(f, object);
  assert_int_equal(is->rows, b.bottom - b.top + 1);
  assert_int_equal(is->width, b.right - b.left + 1);
  assert_int_equal(is->masses, b.masses);
  assert_int_equal(is->row, object == 0 ? 0 : is[-1].row + is[-1].rows);
  for (size_t r = b.top; r <= b.bottom; r++) check_row(o, f, object, &b, r);
}

/* Frees the picture. */
static void check_picture(msr_picture *picture, int neighbours) {
  msri_objects o;
  must(msri_objects_create(picture, neighbours, &o, &why));
  flood f = flood_of(picture, neighbours);
  assert_int_equal(o.n, f.n);
  assert_int_equal(o.row[0], 0);
  for (size_t n = 0; n < o.n; n++) check_object(&o, &f, n);
  const size_t bytes =
      o.n * sizeof *o.object + (o.n_rows + 1) * sizeof *o.row + o.row[o.n_rows] * sizeof *o.piece;
  assert_int_equal(msri_objects_bytes(&o), bytes);
  msri_objects_clear(&o);
  free(f.object);
  free(f.mass);
  msr_picture_free(picture);
}

/* ---- Tests */

static void shapes_fall_into_objects(void **state) {
  (void)state;
  static const size_t sides[] = {1, 2, 3, 7, 16, 33};
  for (size_t n = 0; n < LENGTH(shapes); n++)
    for (size_t w = 0; w < LENGTH(sides); w++)
      for (size_t h = 0; h < LENGTH(sides); h++)
        for (size_t p = 1; p < 6; p++) {
          check_picture(draw(&shapes[n], sides[w], sides[h], p), 4);
          check_picture(draw(&shapes[n], sides[w], sides[h], p), 8);
        }
}

static msr_picture *random_picture(uint64_t *dice) {
  const size_t w = 1 + random_below(dice, 40), h = 1 + random_below(dice, 40);
  const double density = uniform(dice, 0, 1);
  msr_picture *picture;
  must(msr_picture_create(w, h, &picture, &why));
  for (size_t p = 0; p < w * h; p++)
    memcpy(picture->rgb + 3 * p, rgb_of(uniform(dice, 0, 1) < density ? 'o' : '.'), 3);
  return picture;
}

static void random_pictures_fall_into_objects(void **state) {
  (void)state;
  uint64_t dice = 1;
  for (int n = 0; n < 200; n++) check_picture(random_picture(&dice), n % 2 ? 8 : 4);
}

/* Supports belong to none, and part what they are between. */
static void supports_are_no_masses(void **state) {
  (void)state;
  msri_objects o;
  msr_picture *picture = paint("oo#oo\n"
                               "##.#o\n"
                               "o#o##\n");
  must(msri_objects_create(picture, 8, &o, &why));
  assert_int_equal(o.n, 4);
  msri_objects_clear(&o);
  assert_null(o.row);
  assert_int_equal(msri_objects_bytes(&o), 0);
  msr_picture_free(picture);
}

/* Arms that grow together below are one object: its first row is that of the arm that begins first,
 * its left column that of another. */
static void what_meets_later_is_one(void **state) {
  (void)state;
  check_picture(paint("....o\n"
                      "o.o.o\n"
                      "o.ooo\n"
                      "o....\n"
                      "ooooo\n"),
                4);
  check_picture(paint("..o.o.o..\n"
                      ".o.o.o.o.\n"
                      "o.o...o.o\n"),
                8);
}

static const msr_picture *attempted;
static bool create_objects(void) {
  msri_objects o = {0};
  const bool done = msri_objects_create(attempted, 8, &o, &why) == MSR_OK;
  if (!done) assert_true(!o.object && !o.row && !o.piece && o.n == 0 && why.status == MSR_ENOMEM);
  msri_objects_clear(&o);
  return done;
}

static void memory_may_run_out(void **state) {
  (void)state;
  msr_picture *picture = draw(&shapes[LENGTH(shapes) - 1], 60, 60, 3);
  attempted = picture;
  assert_true(alloc_fail_each(create_objects) >= 4);
  msr_picture_free(picture);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shapes_fall_into_objects),
      cmocka_unit_test(random_pictures_fall_into_objects),
      cmocka_unit_test(supports_are_no_masses),
      cmocka_unit_test(what_meets_later_is_one),
      cmocka_unit_test(memory_may_run_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
