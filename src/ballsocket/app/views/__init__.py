"""Views of the page: one question and one package each."""
