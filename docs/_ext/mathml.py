"""Mathematics as MathML at build time: a page needs neither JavaScript nor a network to show its formulas."""

from xml.etree.ElementTree import Element, fromstring, tostring

from docutils.nodes import SkipNode
from latex2mathml.converter import convert

_FUNCTIONS = {"sin", "cos", "tan", "cot", "ln", "exp"}
_NO_SPACE = {"mo", "mspace"}
_NAMESPACE = ' xmlns="http://www.w3.org/1998/Math/MathML"'  # HTML knows


def setup(app):
    app.add_html_math_renderer("mathml", inline_renderers=(_inline, None), block_renderers=(_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def mathml(latex: str, display: str) -> str:
    """A formula, with thin spaces around the names of functions, as TeX has them."""
    formula = fromstring(convert(latex, display=display).replace(_NAMESPACE, ""))
    for row in formula.iter():
        _space(row)
        if row.tag == "mo" and row.text == "/":
            row.attrib.update(lspace="0", rspace="0")
    return tostring(formula, encoding="unicode")


def _inline(self, node):
    self.body.append(mathml(node.astext(), "inline") + "&#8288;")  # no line begins with the comma that follows
    raise SkipNode


def _block(self, node):
    self.body.append(self.starttag(node, "div", CLASS="formula"))
    self.body.append(mathml(node.astext(), "block"))
    if node["number"]:
        self.body.append(f"<span class='eqno'>({node['number']})")
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    self.body.append("</div>\n")
    raise SkipNode


def _space(row: Element) -> None:
    """Thin spaces beside functions, except beside operators and brackets."""
    children = list(row)
    for place in reversed(range(len(children))):
        if row.tag not in ("mrow", "mtd", "msqrt", "mstyle") or not _is_function(children[place]):
            continue
        if place + 1 < len(children) and not _opens_with_operator(children[place + 1]):
            row.insert(place + 1, Element("mspace", width="0.167em"))
        if place > 0 and children[place - 1].tag not in _NO_SPACE:
            row.insert(place, Element("mspace", width="0.167em"))


def _is_function(node: Element) -> bool:
    base = node[0] if node.tag in ("msup", "msub") and len(node) else node
    return base.tag == "mi" and base.text in _FUNCTIONS


def _opens_with_operator(node: Element) -> bool:
    return node.tag in _NO_SPACE or (node.tag == "mrow" and len(node) > 0 and _opens_with_operator(node[0]))
