#include "results/xdmf.h"

#include "base/text.h"
#include "base/whole_file.h"

/** A field at one write: a dataset of its own, which the result file keeps as a view of the series. Tensors are rows of
 * one row each: VTK 9.7 takes two dimensions of a matrix for one matrix of the whole body, and 9.5 has vectors of three
 * only. */
static void add_field(Text *text, const XdmfSeries *series, const XdmfField *field, long long step)
{
  const int k = field->components;
  const char *kind = k == 1 ? "Scalar" : k == 3 ? "Vector" : "Matrix";
  text_add(text,
           "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\"><DataItem Format=\"HDF\" "
           "NumberType=\"Float\" Precision=\"%d\" Dimensions=\"%lld",
           field->name, kind, series->bytes, (long long)series->particles);
  if (k > 1) text_add(text, k == 3 ? " %d" : " 1 %d", k);
  text_add(text, "\">results.vtkhdf:/Breccia/States/%lld/%s</DataItem></Attribute>\n", step, field->name);
}

int xdmf_write(const char *path, const XdmfSeries *series, Error *error)
{
  Text text = {0};
  text_add(&text, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n <Domain>\n"
                  "  <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  long long n = series->particles;
  for (int64_t w = 0; w < series->writes; ++w) {
    text_add(&text,
             "   <Grid Name=\"step %lld\" GridType=\"Uniform\">\n    <Time Value=\"%.17g\"/>\n"
             "    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%lld\" NodesPerElement=\"1\"><DataItem "
             "Format=\"HDF\" NumberType=\"Int\" Precision=\"8\" Dimensions=\"%lld 1\">"
             "results.vtkhdf:/Breccia/Particles</DataItem></Topology>\n"
             "    <Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
             "Dimensions=\"%lld 3\">results.vtkhdf:/VTKHDF/Points</DataItem></Geometry>\n",
             (long long)series->steps[w], series->times[w], n, n, n);
    for (int f = 0; f < series->count; ++f) add_field(&text, series, &series->fields[f], (long long)series->steps[w]);
    text_add(&text, "   </Grid>\n");
  }
  text_add(&text, "  </Grid>\n </Domain>\n</Xdmf>\n");
  const int status = whole_file_write(path, &text, error);
  text_free(&text);
  return status;
}
