// The style sheet of the HTML report. Kept apart because it is a language of its own.
#pragma once

#include <string_view>

namespace striae::report::detail {

inline constexpr std::string_view kHtmlStyle = R"css(
:root{--ink:#26323a;--grey:#5f6e77;--line:#e1e7ea;--soft:#f5f8f9;--accent:#26677f;--good:#1d7a55;--bad:#b2402c;--flag:#8a5a00;--flagbg:#fdf3dc}
*{box-sizing:border-box}
body{margin:0;background:#eef2f4;color:var(--ink);font:15px/1.5 Inter,"Helvetica Neue",Arial,"DejaVu Sans",sans-serif;font-variant-numeric:tabular-nums}
main{max-width:980px;margin:24px auto;background:#fff;padding:36px 44px 28px;border-radius:10px;box-shadow:0 1px 3px rgba(38,50,58,.12)}
h1{font-size:30px;line-height:1.2;margin:0;font-weight:650;letter-spacing:-.01em}
h2{font-size:19px;margin:34px 0 12px;font-weight:650}
h3{font-size:14px;margin:26px 0 8px;font-weight:600;color:var(--grey)}
.subtitle{margin:2px 0 18px;color:var(--grey);font-size:16px}
dl{display:grid;grid-template-columns:repeat(2,minmax(0,1fr));gap:8px 36px;margin:0;padding:14px 0;border-top:2px solid var(--accent);border-bottom:1px solid var(--line)}
dl div{display:grid;grid-template-columns:92px minmax(0,1fr);gap:10px;font-size:14px}
dt{color:var(--grey)}dd{margin:0;overflow-wrap:anywhere}.part{display:inline-block}
.warning{margin:16px 0 0;padding:10px 14px;border-left:4px solid var(--bad);background:#fbefec;font-weight:600}
.headlines{display:flex;flex-wrap:wrap;gap:12px}
.headline{flex:1 1 190px;background:var(--soft);border-radius:8px;padding:12px 16px}
.headline .name{color:var(--grey);font-size:13px}
.headline .big{font-size:21px;font-weight:600;line-height:1.35}
.headline .big small{font-size:14px;font-weight:400;color:var(--grey)}
.second{color:var(--grey);font-size:13px}
.second>span{white-space:nowrap;margin-right:.55em}
.second>.why{white-space:normal}
.words{font-size:13px}
.verdict{font-weight:600}
.improved{color:var(--good)}.worse{color:var(--bad)}.none{color:var(--grey)}
.flag{background:var(--flagbg);color:var(--flag);border-radius:4px;padding:0 5px;font-size:12px;font-weight:600;white-space:nowrap}
table{border-collapse:collapse;width:100%;margin:16px 0 0;font-size:14px;table-layout:fixed}
th,td{text-align:left;vertical-align:top;padding:7px 10px 7px 0;border-bottom:1px solid var(--line)}
thead th{border-bottom:2px solid var(--line);font-weight:600;padding-top:0}
thead th span{display:block;font-weight:400;color:var(--grey);font-size:13px}
tbody th{font-weight:600}tbody th span{font-weight:400;color:var(--grey)}
col.quantity{width:22%}col.first{width:16%}
.value{font-weight:500}
tr.notes td{border-bottom:0;font-size:13px;color:var(--flag)}tr.notes th{border-bottom:0;color:var(--grey);font-weight:400}
.note,figcaption{font-size:13px;color:var(--grey);margin:8px 0 0}
figure{margin:0}
.plots{display:flex;flex-wrap:wrap;gap:18px;margin-top:24px}
.plots>svg{flex:1 1 300px;min-width:0;width:100%;height:auto;font-family:inherit}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(250px,1fr));gap:20px;margin-top:22px}
.card{break-inside:avoid}
.card .pair{display:grid;gap:6px}
.card img{display:block;width:100%;height:auto;max-height:300px;object-fit:contain;object-position:left top}
.lost{padding:24px 12px;background:var(--soft);border-radius:6px;font-size:13px;color:var(--grey);text-align:center}
ul{margin:0;padding-left:20px;font-size:14px}li{margin:3px 0;overflow-wrap:anywhere}
footer{margin-top:34px;padding-top:12px;border-top:1px solid var(--line);font-size:12.5px;color:var(--grey)}
footer p{margin:0 0 5px}
@media (max-width:640px){
main{margin:0;padding:20px 16px;border-radius:0}dl{grid-template-columns:minmax(0,1fr)}
table,tbody,tr,td,tbody th{display:block;width:100%}thead{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%)}
tbody tr{padding:12px 0;border-bottom:1px solid var(--line)}th,td{border:0;padding:3px 0}
td::before{content:attr(data-visit);display:block;color:var(--grey);font-size:12px}
tr.notes td:empty,tr.notes td.empty{display:none}
}
@page{size:A4;margin:8mm 11mm}
@media print{
body{background:#fff;font-size:8.4pt;line-height:1.28;-webkit-print-color-adjust:exact;print-color-adjust:exact}
main{max-width:none;margin:0;padding:0;box-shadow:none;border-radius:0}
h1{font-size:16pt}h2{font-size:11.5pt;margin:8pt 0 4pt;break-after:avoid}h3{font-size:8.6pt;margin:9pt 0 3pt}
.subtitle{font-size:9.5pt;margin:0 0 6pt}dl{padding:5pt 0;gap:2pt 20pt}dl div{font-size:7.6pt;grid-template-columns:56pt minmax(0,1fr);gap:6pt}
.headline{padding:4pt 9pt}.headline .big{font-size:12.5pt}.headline .big small{font-size:8pt}.headline .name,.second,.words{font-size:7.2pt}
table{font-size:7.9pt;margin-top:7pt}th,td{padding:1.1pt 6pt 1.1pt 0}tr{break-inside:avoid}thead th span,tr.notes td,.flag{font-size:7.2pt}
.plots{margin-top:6pt;flex-wrap:nowrap;break-inside:avoid}.note,figcaption{font-size:7pt;margin-top:3pt}
.pictures{grid-template-columns:repeat(3,minmax(0,1fr));gap:8pt;margin-top:8pt}.card .pair{grid-template-columns:1fr 1fr;align-items:start}.card img{max-height:70pt}
ul{font-size:7.6pt;padding-left:12pt}li{margin:1pt 0}footer{margin-top:9pt;padding-top:4pt;font-size:6.6pt}footer p{margin:0 0 2pt}
}
)css";

}  // namespace striae::report::detail
