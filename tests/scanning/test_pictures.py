"""Files of scans: their pages in order, whatever the format, and what is not a picture said by name."""

import cv2
import numpy as np
import pytest

from coursework.scanning.pictures import BadPicture, page_count, picture_at, pictures, without_streaks


def page(k):
    """A page that is told by where it is dark."""
    grey = np.full((330, 240), 240, np.uint8)
    grey[40 + 60 * k : 80 + 60 * k, 30:200] = 20
    return grey


def darkest(grey):
    return int(np.argmin(grey.mean(axis=1)) / grey.shape[0] * 330 - 40) // 60


def pdf(path, pages):
    import pypdfium2

    document = pypdfium2.PdfDocument.new()
    for grey in pages:
        image = pypdfium2.PdfImage.new(document)
        bitmap = pypdfium2.PdfBitmap.new_native(*grey.shape[::-1], pypdfium2.raw.FPDFBitmap_BGR)
        bitmap.to_numpy()[:] = grey[..., np.newaxis]
        image.set_bitmap(bitmap)
        image.set_matrix(pypdfium2.PdfMatrix().scale(grey.shape[1], grey.shape[0]))
        sheet = document.new_page(grey.shape[1], grey.shape[0])
        sheet.insert_obj(image)
        sheet.gen_content()
    document.save(path)


@pytest.mark.parametrize("ending", [".png", ".jpg", ".tif", ".pdf"])
def test_a_file_gives_its_pages_in_order(ending, tmp_path):
    path = tmp_path / f"scan{ending}"
    wanted = [page(k) for k in range(3)] if ending in (".tif", ".pdf") else [page(2)]
    if ending == ".pdf":
        pdf(path, wanted)
    elif ending == ".tif":
        cv2.imwritemulti(str(path), wanted)
    else:
        cv2.imwrite(str(path), wanted[0])
    found = list(pictures(path))
    assert [one.page for one in found] == list(range(1, len(wanted) + 1))
    assert page_count(path) == len(wanted)
    for k, (one, grey) in enumerate(zip(found, wanted, strict=True), start=1):
        assert darkest(one.grey) == darkest(grey)
        assert one.grey.ndim == 2
        assert (picture_at(path, k).grey == one.grey).all()


@pytest.mark.parametrize("name", ["notes.txt", "broken.pdf", "broken.png", "broken.tif", "short.jpg"])
def test_what_is_no_picture_is_said_by_name(name, tmp_path):
    path = tmp_path / name
    whole = cv2.imencode(".jpg", page(0))[1].tobytes()
    path.write_bytes(whole[:20] if name == "short.jpg" else b"no picture")
    with pytest.raises(BadPicture, match=name):
        list(pictures(path))


def test_a_streak_is_taken_away_and_ink_under_it_stays():
    grey = np.full((400, 300), 235, np.uint8)
    grey[100:300, 148:153] = 60  # a stroke down the page, not all along
    dirty = grey.astype(int)
    dirty[:, [90, 150]] -= 50
    cleaned = without_streaks(np.clip(dirty, 0, 255).astype(np.uint8)).astype(int)
    assert np.abs(cleaned[:, 80:100] - 235).max() <= 3
    assert cleaned[100:300, 148:153].max() < 130
    assert np.abs(cleaned[:90, 148:153] - 235).max() <= 3


def test_a_printed_frame_is_no_streak():
    grey = np.full((400, 300), 235, np.uint8)
    grey[60:340, 50] = grey[60:340, 250] = 150
    assert (without_streaks(grey) == grey).all()


@pytest.mark.parametrize("depth", [np.uint8, np.uint16])
def test_what_is_transparent_lies_on_white_paper(depth, tmp_path):
    most = np.iinfo(depth).max
    drawn = np.zeros((300, 200, 4), depth)
    drawn[100:120, 50:150, 3] = most
    cv2.imwrite(str(tmp_path / "scan.png"), drawn)
    grey = picture_at(tmp_path / "scan.png", 1).grey
    assert (grey[:90] == 255).all()
    assert (grey[102:118, 52:148] == 0).all()


def test_a_strip_of_a_few_pixels_is_said_by_name(tmp_path):
    cv2.imwrite(str(tmp_path / "line.png"), np.full((1, 5000), 255, np.uint8))
    with pytest.raises(BadPicture, match=r"line\.png is 5000 by 1 pixels"):
        picture_at(tmp_path / "line.png", 1)
