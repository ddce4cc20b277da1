"""The material of a design: a file of one's own is opened, kept, changed, removed and shared."""

import re

from playwright.sync_api import expect

import gestures as do
from simulearn.material import material_text


def own(title="My PLA", **changes):
    """Return the file of PLA with a name of its own and other values of keys."""
    text = material_text("pla-hot-water")
    values = {"name": '"my-pla"', "title": f'"{title}"', **changes}
    for key, value in values.items():
        text = re.sub(rf"^{key} = .*$", f"{key} = {value}", text, count=1, flags=re.MULTILINE)
    return text.encode()


def open_material(page, content, name="my-pla.toml"):
    """Open a material with the panel's button."""
    with page.expect_file_chooser() as choosing:
        do.button(page, "Open a material…").click()
    file = {"name": name, "mimeType": "application/toml", "buffer": content}
    choosing.value.set_files(file)


def words(page):
    """Return what the line below says of the shape."""
    return do.status(page).locator(".status-main").inner_text()


def test_a_material_of_ones_own_is_used_kept_and_shared(page, studio, visit):
    do.opened(page, studio.url)
    chosen = page.get_by_label("Material", exact=True)
    expect(chosen).to_have_value("pla-hot-water")
    expect(page.get_by_text("7.2 × 4.0 mm, strain 9.3 %, scatter 17.0 %")).to_be_visible()
    before = words(page)
    mine = own(width="9.0", curl="0.01")
    open_material(page, mine)
    expect(chosen.locator("option:checked")).to_have_text("My PLA (own)")
    expect(page.get_by_text("9.0 × 4.0 mm, strain 9.3 %, own curl +1.0 %, scatter")).to_be_visible()
    expect(page.get_by_text("The learned model knows it.")).to_be_visible()
    expect(do.status(page).locator(".status-main")).not_to_have_text(before)
    do.simulated(page)
    after = words(page)
    checks = do.tab(page, "Check")
    do.button(checks, "Show how prints differ").click()
    expect(checks.get_by_text("Prints differ by")).to_be_visible()
    do.tab(page, "Design")
    with page.expect_download() as waiting:
        do.button(page, "Save material").click()
    assert waiting.value.suggested_filename == "my-pla.toml"
    assert do.downloaded(waiting.value).encode() == mine

    document = do.document(page)
    assert document["materials"] == [mine.decode()]
    assert document["grid"]["material"] == "my-pla"
    do.saved(page)
    page.reload()
    expect(chosen.locator("option:checked")).to_have_text("My PLA (own)")
    do.says(page, after)
    other = do.opened(visit(), studio.url)  # somebody else, who is sent the file
    do.open_file(other, "design.json", document)
    do.says(other, after)

    do.button(page, "Remove").click()
    expect(chosen).to_have_value("pla-hot-water")
    do.says(page, before)
    assert do.document(page)["materials"] == []


def test_what_is_wrong_with_a_material_and_what_the_model_does_not_know(page, studio, forgiven):
    forgiven.append("status of 422")
    do.opened(page, studio.url)
    open_material(page, own(poisson="0.6"), "bad.toml")
    dialog = page.get_by_role("dialog", name="bad.toml cannot be opened")
    expect(dialog).to_contain_text("law.poisson is 0.6")
    do.button(dialog, "Close").last.click()
    do.open_file(page, "wide.toml", own("Wide", width="16.0", shell="2.0"))  # as any file
    expect(page.get_by_text("The learned model does not know it")).to_be_visible()
    do.button(page, "Compute by finite elements").first.click()
    expect(page.get_by_text("the one shown is that of finite elements")).to_be_visible()
    do.simulated(page)
