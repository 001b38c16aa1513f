"""What an export could not carry over, each thing once by name."""


class Report:
    def __init__(self):
        self.lines = {}

    def lost(self, what, where=""):
        """`what` is not exported (a feature, as the user knows it), at `where` (an object, a material)."""
        places = self.lines.setdefault(what, [])
        if where and where not in places:
            places.append(where)

    def texts(self):
        """One line a feature, with the first places where it was met."""
        out = []
        for what, places in self.lines.items():
            shown = ", ".join(places[:4]) + (" and %d more" % (len(places) - 4) if len(places) > 4 else "")
            out.append(what + (" (%s)" % shown if shown else ""))
        return out

    def __bool__(self):
        return bool(self.lines)
